#include "io/hdf5_output.hpp"

#include "io/hdf5_seal.hpp"
#include "io/record_log.hpp"
#include "solver/errors.hpp"

#include <H5FDpublic.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <utility>

namespace grandamp::hdf5 {
namespace {

/// What HDF5 holds of an open file: its own part must stand first.
struct DriverFile {
  H5FD_t own;
  Output::Sink* sink;
  haddr_t allocated; ///< bytes that HDF5 means to use
  haddr_t end;       ///< bytes there are
};

DriverFile* ours(H5FD_t* file) {
  return reinterpret_cast<DriverFile*>(file);
}
const DriverFile* ours(const H5FD_t* file) {
  return reinterpret_cast<const DriverFile*>(file);
}

void keep_error(Output::Sink& sink) {
  if (sink.error == 0) sink.error = errno;
}

H5FD_t* driver_open(const char*, unsigned, hid_t access, haddr_t) {
  const auto* info = static_cast<Output::Sink* const*>(H5Pget_driver_info(access));
  if (info == nullptr) return nullptr;
  return &(new DriverFile{{}, *info, 0, 0})->own;
}

herr_t driver_close(H5FD_t* file) {
  delete ours(file);
  return 0;
}

herr_t driver_query(const H5FD_t*, unsigned long* flags) {
  if (flags != nullptr)
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

haddr_t driver_get_allocated(const H5FD_t* file, H5FD_mem_t) {
  return ours(file)->allocated;
}

herr_t driver_set_allocated(H5FD_t* file, H5FD_mem_t, haddr_t address) {
  ours(file)->allocated = address;
  return 0;
}

haddr_t driver_get_end(const H5FD_t* file, H5FD_mem_t) {
  return ours(file)->end;
}

herr_t driver_read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, void* buffer) {
  auto* to = static_cast<char*>(buffer);
  auto at = static_cast<off_t>(address);
  while (size > 0) {
    const ssize_t done = ::pread(ours(file)->sink->file, to, size, at);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) keep_error(*ours(file)->sink);
    if (done <= 0) break;
    to += done;
    at += done;
    size -= static_cast<std::size_t>(done);
  }
  std::memset(to, 0, size); // beyond what is there
  return 0;
}

herr_t driver_write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, const void* buffer) {
  Output::Sink& sink = *ours(file)->sink;
  const auto* from = static_cast<const char*>(buffer);
  auto at = static_cast<off_t>(address);
  ours(file)->end = std::max<haddr_t>(ours(file)->end, address + size);
  while (size > 0 && sink.error == 0) {
    const ssize_t done = ::pwrite(sink.file, from, size, at);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) {
      keep_error(sink);
      break;
    }
    from += done;
    at += done;
    size -= static_cast<std::size_t>(done);
  }
  return 0;
}

herr_t driver_truncate(H5FD_t* file, hid_t, hbool_t) {
  DriverFile& f = *ours(file);
  if (f.sink->error == 0 && ::ftruncate(f.sink->file, static_cast<off_t>(f.allocated)) != 0) keep_error(*f.sink);
  f.end = f.allocated;
  return 0;
}

hid_t driver() {
  static const hid_t id = [] {
    H5FD_class_t driver{};
    driver.name = "grandamp";
    driver.maxaddr = static_cast<haddr_t>(1) << 62;
    driver.fc_degree = H5F_CLOSE_STRONG;
    driver.fapl_size = sizeof(Output::Sink*);
    driver.open = driver_open;
    driver.close = driver_close;
    driver.query = driver_query;
    driver.get_eoa = driver_get_allocated;
    driver.set_eoa = driver_set_allocated;
    driver.get_eof = driver_get_end;
    driver.read = driver_read;
    driver.write = driver_write;
    driver.truncate = driver_truncate;
    const H5FD_mem_t map[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
    std::copy(std::begin(map), std::end(map), driver.fl_map);
    return H5FDregister(&driver);
  }();
  return id;
}

} // namespace

Output::Output(const std::filesystem::path& path) : path_(path), beside_(path), sink_(new Sink) {
  beside_ += ".new";
  sink_->file = ::open(beside_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (sink_->file >= 0) return;
  const int reason = errno;
  delete std::exchange(sink_, nullptr);
  fail("create", reason);
}

Output::Output(Output&& other) noexcept
    : path_(std::move(other.path_)), beside_(std::move(other.beside_)), sink_(std::exchange(other.sink_, nullptr)) {}

Output& Output::operator=(Output&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(beside_, other.beside_);
  std::swap(sink_, other.sink_);
  return *this;
}

Output::~Output() {
  if (sink_ == nullptr) return;
  if (sink_->file >= 0) {
    ::close(sink_->file);
    ::unlink(beside_.c_str());
  }
  delete sink_;
}

void Output::fail(const char* what, int reason) const {
  throw FileError(path_.string() + ": cannot " + what + " the file: " + std::strerror(reason));
}

hid_t Output::access() {
  const hid_t list = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_driver(list, driver(), &sink_);
  return list;
}

void Output::finish() {
  if (sink_->error == 0 && !write_seal(sink_->file)) keep_error(*sink_);
  if (sink_->error == 0 && ::fsync(sink_->file) != 0) keep_error(*sink_);
  if (sink_->error != 0) fail("write", sink_->error);
  if (std::rename(beside_.c_str(), path_.c_str()) != 0) fail("replace", errno);
  ::close(std::exchange(sink_->file, -1));
  sync_folder(path_.parent_path());
}

} // namespace grandamp::hdf5
