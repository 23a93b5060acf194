#include "io/record_log.hpp"

#include "io/digest.hpp"
#include "solver/errors.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

namespace grandamp {
namespace {

constexpr std::size_t header_bytes = 64;
constexpr std::size_t block_bytes = 1 << 16;
constexpr std::string_view magic = "grandamp log 1\n";
constexpr std::size_t kind_at = 16, most_kind = 24, size_at = 40;

using Header = std::array<char, header_bytes>;

Header header_of(std::string_view kind, std::size_t record_bytes) {
  Header header{};
  std::copy(magic.begin(), magic.end(), header.begin());
  std::copy_n(kind.begin(), std::min(kind.size(), most_kind), header.begin() + kind_at);
  const std::uint64_t size = record_bytes;
  std::memcpy(header.data() + size_at, &size, sizeof size);
  return header;
}

bool write_all(int file, const void* data, std::size_t bytes, off_t at) {
  const char* from = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t done = ::pwrite(file, from, bytes, at);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return false;
    from += done;
    at += done;
    bytes -= static_cast<std::size_t>(done);
  }
  return true;
}

/// How many bytes there were; less than asked for at the file's end, -1 on an error.
ssize_t read_all(int file, void* data, std::size_t bytes, off_t at) {
  char* to = static_cast<char*>(data);
  std::size_t sum = 0;
  while (sum < bytes) {
    const ssize_t done = ::pread(file, to + sum, bytes - sum, at + static_cast<off_t>(sum));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return -1;
    if (done == 0) break;
    sum += static_cast<std::size_t>(done);
  }
  return static_cast<ssize_t>(sum);
}

} // namespace

RecordLog RecordLog::create(const std::filesystem::path& path, std::string_view kind, std::size_t record_bytes) {
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  RecordLog log(path, file, record_bytes);
  if (file < 0) log.fail("create");
  const Header header = header_of(kind, record_bytes);
  if (!write_all(file, header.data(), header.size(), 0)) log.fail("write");
  return log;
}

RecordLog RecordLog::open(const std::filesystem::path& path, std::string_view kind, std::size_t record_bytes,
                          bool look) {
  const int file = ::open(path.c_str(), (look ? O_RDONLY : O_RDWR) | O_CLOEXEC);
  RecordLog log(path, file, record_bytes);
  if (file < 0) log.fail("open");
  Header header{};
  if (read_all(file, header.data(), header.size(), 0) < 0) log.fail("read");
  if (record_bytes == 0) {
    std::uint64_t size = 0;
    std::memcpy(&size, header.data() + size_at, sizeof size);
    log.record_bytes_ = static_cast<std::size_t>(size);
  }
  if (header != header_of(kind, log.record_bytes_) || log.record_bytes_ == 0)
    throw FileError(path.string() + ": is no log of this run's " + std::string(kind) + ", or its start is damaged");
  log.count_ = log.written_ = log.whole_records();
  return log;
}

RecordLog::RecordLog(RecordLog&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)), record_bytes_(other.record_bytes_),
      count_(other.count_), written_(other.written_), waiting_(std::move(other.waiting_)) {}

RecordLog& RecordLog::operator=(RecordLog&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(file_, other.file_);
  std::swap(record_bytes_, other.record_bytes_);
  std::swap(count_, other.count_);
  std::swap(written_, other.written_);
  std::swap(waiting_, other.waiting_);
  return *this;
}

RecordLog::~RecordLog() {
  if (file_ >= 0) ::close(file_);
}

void RecordLog::fail(const char* what) const {
  throw FileError(path_.string() + ": cannot " + what + " the file: " + std::strerror(errno));
}

std::int64_t RecordLog::offset_of(std::int64_t record) const noexcept {
  return static_cast<std::int64_t>(header_bytes) + record * static_cast<std::int64_t>(stride());
}

std::int64_t RecordLog::whole_records() const {
  struct stat status {};
  if (::fstat(file_, &status) != 0) fail("read");
  const std::int64_t there =
      std::max<std::int64_t>(0, status.st_size - offset_of(0)) / static_cast<std::int64_t>(stride());
  std::vector<std::byte> block;
  const auto at_once = static_cast<std::int64_t>(std::max<std::size_t>(1, block_bytes / stride()));
  std::int64_t whole = 0;
  while (whole < there) {
    const std::int64_t next = std::min(at_once, there - whole);
    if (read_whole(whole, next, block, nullptr)) {
      whole += next;
      continue;
    }
    while (whole < there && read_whole(whole, 1, block, nullptr)) ++whole;
    break;
  }
  return whole;
}

bool RecordLog::read_whole(std::int64_t first, std::int64_t count, std::vector<std::byte>& block, void* records) const {
  block.resize(static_cast<std::size_t>(count) * stride());
  const ssize_t there = read_all(file_, block.data(), block.size(), offset_of(first));
  if (there < 0) fail("read");
  if (static_cast<std::size_t>(there) < block.size()) return false;
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    const std::byte* record = block.data() + k * stride();
    std::uint64_t digest = 0;
    std::memcpy(&digest, record + record_bytes_, sizeof digest);
    // Its own number goes into the digest, so that no other record is taken for it.
    const std::uint64_t number = static_cast<std::uint64_t>(first) + k;
    if (digest != (digest_of(record, record_bytes_) ^ number)) return false;
    if (records != nullptr) std::memcpy(static_cast<std::byte*>(records) + k * record_bytes_, record, record_bytes_);
  }
  return true;
}

void RecordLog::append(const void* record) {
  const auto* bytes = static_cast<const std::byte*>(record);
  waiting_.insert(waiting_.end(), bytes, bytes + record_bytes_);
  const std::uint64_t digest = digest_of(record, record_bytes_) ^ static_cast<std::uint64_t>(count_);
  const auto* tail = reinterpret_cast<const std::byte*>(&digest);
  waiting_.insert(waiting_.end(), tail, tail + sizeof digest);
  ++count_;
  if (waiting_.size() >= block_bytes) flush();
}

void RecordLog::flush() {
  if (waiting_.empty()) return;
  if (!write_all(file_, waiting_.data(), waiting_.size(), offset_of(written_))) fail("write");
  written_ = count_;
  waiting_.clear();
}

void RecordLog::sync() {
  flush();
  if (::fdatasync(file_) != 0) fail("write");
  // A file that was removed can still be written to, but nobody will ever read it.
  struct stat here {
  }, there{};
  if (::fstat(file_, &here) != 0) fail("write");
  if (::stat(path_.c_str(), &there) != 0) fail("find");
  if (here.st_ino != there.st_ino || here.st_dev != there.st_dev)
    throw FileError(path_.string() + ": the file was replaced by another while the run wrote to it");
}

void RecordLog::cut(std::int64_t count) {
  flush();
  if (count >= count_) return;
  if (::ftruncate(file_, offset_of(count)) != 0) fail("shorten");
  count_ = written_ = count;
}

void RecordLog::rename(const std::filesystem::path& path) {
  if (std::rename(path_.c_str(), path.c_str()) != 0) fail("rename");
  path_ = path;
}

void RecordLog::read(std::int64_t first, std::int64_t count, void* records) const {
  std::vector<std::byte> block;
  if (!read_whole(first, count, block, records))
    throw FileError(path_.string() + ": is damaged between record " + std::to_string(first) + " and " +
                    std::to_string(first + count));
}

void sync_folder(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder.empty() ? "." : folder;
  const int file = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool done = file >= 0 && ::fsync(file) == 0;
  const int reason = errno;
  if (file >= 0) ::close(file);
  // Some file systems cannot sync a folder; then there is nothing more to be done.
  if (!done && reason != EINVAL && reason != ENOTSUP)
    throw FileError(path.string() + ": cannot write the folder: " + std::strerror(reason));
}

} // namespace grandamp
