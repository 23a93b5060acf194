// HDF5's C interface behind handles that close themselves and calls that throw FileError with the file and the reason.
#pragma once

#include "io/hdf5_output.hpp"

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace grandamp::hdf5 {

/// Owns one HDF5 identifier of any kind.
class Handle {
public:
  using Close = herr_t (*)(hid_t);

  Handle() = default;
  Handle(hid_t id, Close how) : id_(id), close_(how) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() { close(); }

  hid_t id() const noexcept { return id_; }
  explicit operator bool() const noexcept { return id_ >= 0; }
  /// Whether closing went well. What is buffered reaches the disk only here.
  bool close() noexcept {
    const hid_t id = std::exchange(id_, -1);
    return id < 0 || close_(id) >= 0;
  }

private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// While it lives HDF5 prints nothing on standard error: its complaints become FileError instead.
class Silence {
public:
  Silence();
  ~Silence();
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// What a dataset is, for a person.
struct Dataset {
  std::string type;                      ///< "float64", "int32", "text", ...
  std::vector<unsigned long long> shape; ///< empty: one value
  std::string units, description;
};

/// An open file. Every member throws FileError ("PATH: cannot WHAT: REASON").
///
/// A file that is created takes its place, whole and sealed, when it is closed; until then, and if it is never closed,
/// what was there before stays. Memory stays flat: what is written goes to the disk (hdf5_output.hpp).
class File {
public:
  /// Replaces a file that exists.
  static File create(const std::filesystem::path& path);
  /// For reading: a file that was closed here and is whole, by its seal; HDF5 1.10 may crash on one that is not.
  static File open(const std::filesystem::path& path);
  /// Any file, damaged or not: only in a process that may crash.
  static File open_at_risk(const std::filesystem::path& path);

  const std::filesystem::path& path() const noexcept { return path_; }
  void close();

  bool has(const std::string& name) const;
  /// Nothing if there is no dataset of that name.
  std::optional<Dataset> dataset(const std::string& name) const;
  /// Names and values, as text, of an object's attributes.
  std::vector<std::pair<std::string, std::string>> attributes(const std::string& object) const;
  /// Names of a group's members, in the order of their creation.
  std::vector<std::string> members(const std::string& group) const;
  void create_group(const std::string& name);

  /// A one-dimensional dataset of doubles that can grow; `rows` are to be expected.
  Handle create_column(const std::string& name, std::size_t rows);
  void append(const Handle& column, std::size_t rows_before, const std::vector<double>& values);

  /// Datasets of fixed size; `width` values per row make it two-dimensional.
  void write(const std::string& name, const std::vector<double>& values, std::size_t width = 1);
  void write(const std::string& name, const std::vector<float>& values, std::size_t width = 1);
  void write(const std::string& name, const std::vector<std::int64_t>& values);
  void write(const std::string& name, const std::vector<std::int32_t>& values);
  void write(const std::string& name, const std::string& text);

  /// Any numeric dataset, row by row.
  std::vector<double> read_doubles(const std::string& name) const;
  std::vector<float> read_floats(const std::string& name) const;
  std::vector<std::int64_t> read_integers(const std::string& name) const;
  /// A second name for the same object.
  void link(const std::string& object, const std::string& name);
  std::string read_text(const std::string& name) const;

  void set_attribute(const std::string& object, const std::string& name, const std::string& value);
  void set_attribute(const std::string& object, const std::string& name, double value);
  void set_attribute(const std::string& object, const std::string& name, std::int64_t value);
  double double_attribute(const std::string& object, const std::string& name) const;
  std::string text_attribute(const std::string& object, const std::string& name) const;

private:
  explicit File(std::filesystem::path path) : path_(std::move(path)) {}
  [[noreturn]] void fail(const std::string& what) const;
  Handle owned(hid_t id, Handle::Close how, const std::string& what) const;
  void require(herr_t status, const std::string& what) const;
  void write_values(const std::string& name, hid_t type, const void* data, const std::vector<hsize_t>& shape);
  std::size_t count_of(const Handle& dataset, const std::string& name) const;
  template <class Number> std::vector<Number> read_numbers(const std::string& name, hid_t type) const;
  /// Reading into one value needs one: files that were damaged and sealed again hold anything.
  void demand_one(const Handle& type, const Handle& space, H5T_class_t wanted, const std::string& name) const;
  void put_attribute(const std::string& object, const std::string& name, hid_t type, const void* value);

  std::filesystem::path path_;
  std::optional<Output> output_; ///< of a file that is created; stands before the file, which is closed first
  Handle file_;
};

} // namespace grandamp::hdf5
