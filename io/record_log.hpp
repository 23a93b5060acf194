// A file of records of one size that only grows: what a run must not lose between two whole results files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace grandamp {

/// Every record carries its digest, so that a record that was half written when the power went is known for one.
/// All members throw FileError with the path and the reason. The file: 64 bytes of header, then the records, each
/// followed by 8 bytes of digest.
class RecordLog {
public:
  /// A new, empty one; replaces a file that exists. `kind` is told in the header, at most 24 characters.
  static RecordLog create(const std::filesystem::path& path, std::string_view kind, std::size_t record_bytes);
  /// One that exists, of this kind and size of record (0: of any size). To go on with it, or to `look` at it: for
  /// reading alone, while another may be writing to it.
  static RecordLog open(const std::filesystem::path& path, std::string_view kind, std::size_t record_bytes,
                        bool look = false);

  RecordLog(RecordLog&& other) noexcept;
  RecordLog& operator=(RecordLog&& other) noexcept;
  ~RecordLog();

  const std::filesystem::path& path() const noexcept { return path_; }
  std::size_t record_bytes() const noexcept { return record_bytes_; }
  /// Records appended so far; after open, the whole ones from the start on that the file holds.
  std::int64_t count() const noexcept { return count_; }

  /// Kept back and written in blocks of about 64 KiB.
  void append(const void* record);
  /// What was appended is with the system: it outlives this program, but not a power cut.
  void flush();
  /// What was appended is on the disk, and the file is still where it was.
  void sync();
  /// Forgets the records from this one on.
  void cut(std::int64_t count);
  /// Moves the file, over one that exists.
  void rename(const std::filesystem::path& path);
  /// The records first, first + 1, ..., one behind another. Reads only what was flushed.
  void read(std::int64_t first, std::int64_t count, void* records) const;

private:
  RecordLog(std::filesystem::path path, int file, std::size_t record_bytes)
      : path_(std::move(path)), file_(file), record_bytes_(record_bytes) {}
  [[noreturn]] void fail(const char* what) const;
  std::size_t stride() const noexcept { return record_bytes_ + sizeof(std::uint64_t); }
  std::int64_t offset_of(std::int64_t record) const noexcept;
  bool read_whole(std::int64_t first, std::int64_t count, std::vector<std::byte>& block, void* records) const;
  std::int64_t whole_records() const;

  std::filesystem::path path_;
  int file_ = -1;
  std::size_t record_bytes_ = 0;
  std::int64_t count_ = 0;
  std::int64_t written_ = 0;
  std::vector<std::byte> waiting_;
};

/// Puts a folder's own entries on the disk: renames in it are then safe. Throws FileError.
void sync_folder(const std::filesystem::path& folder);

} // namespace grandamp
