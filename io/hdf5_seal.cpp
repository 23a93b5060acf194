#include "io/hdf5_seal.hpp"

#include "io/digest.hpp"
#include "solver/errors.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <vector>

namespace grandamp::hdf5 {
namespace {

constexpr std::size_t most_parts = 64, least_part = 1 << 16;
constexpr std::string_view opening = "grandamp, HDF5 after 2048 bytes, digests XXH3\n";

std::string hexadecimal(std::uint64_t value) {
  return fmt::format("{:016x}", value);
}

std::size_t part_for(std::size_t bytes) {
  std::size_t part = least_part;
  while (part * most_parts < bytes) part *= 2;
  return part;
}

ssize_t read_at(int file, void* data, std::size_t bytes, std::size_t at) {
  std::size_t sum = 0;
  while (sum < bytes) {
    const ssize_t done = ::pread(file, static_cast<char*>(data) + sum, bytes - sum, static_cast<off_t>(at + sum));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return -1;
    if (done == 0) break;
    sum += static_cast<std::size_t>(done);
  }
  return static_cast<ssize_t>(sum);
}

/// Of the parts from the seal on to `bytes`; nothing with errno if the file cannot be read.
std::optional<std::vector<std::string>> digests_of(int file, std::size_t bytes) {
  const std::size_t part = part_for(bytes);
  std::vector<char> block(std::min<std::size_t>(part, 1 << 20));
  std::vector<std::string> digests;
  for (std::size_t begin = 0; begin < bytes; begin += part) {
    Digest digest;
    const std::size_t end = std::min(bytes, begin + part);
    for (std::size_t at = std::max(begin, seal_bytes); at < end;) {
      const ssize_t there = read_at(file, block.data(), std::min(block.size(), end - at), at);
      if (there < 0) return std::nullopt;
      if (there == 0) break;
      digest.add(block.data(), static_cast<std::size_t>(there));
      at += static_cast<std::size_t>(there);
    }
    digests.push_back(digest.text().substr(0, 16));
  }
  return digests;
}

std::string heading(std::size_t bytes) {
  return fmt::format("{}bytes {}\npart {}\n", opening, bytes, part_for(bytes));
}

/// The seal's text but for its own digest, which stands at its end: `seal 0123456789abcdef`.
std::string text_of(std::size_t bytes, const std::vector<std::string>& digests) {
  std::string text = heading(bytes);
  for (const std::string& digest : digests) text += digest + "\n";
  text.resize(seal_bytes - 23, ' ');
  return text + "\nseal ";
}

std::string sealed(std::string text) {
  text += hexadecimal(digest_of(text.data(), text.size()));
  return text + "\n";
}

struct Descriptor {
  int file;
  ~Descriptor() {
    if (file >= 0) ::close(file);
  }
};

SealReport damaged(std::string what) {
  return {SealReport::State::damaged, std::move(what)};
}

} // namespace

bool write_seal(int file) {
  struct stat status {};
  if (::fstat(file, &status) != 0) return false;
  const auto bytes = static_cast<std::size_t>(status.st_size);
  const auto digests = digests_of(file, bytes);
  if (!digests) return false;
  const std::string seal = sealed(text_of(bytes, *digests));
  const ssize_t done = ::pwrite(file, seal.data(), seal.size(), 0);
  if (done >= 0 && static_cast<std::size_t>(done) != seal.size()) errno = ENOSPC;
  return done == static_cast<ssize_t>(seal.size());
}

SealReport check_seal(const std::filesystem::path& path) {
  const auto fail = [&path] { throw FileError(path.string() + ": cannot read the file: " + std::strerror(errno)); };
  const Descriptor opened{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  struct stat status {};
  if (opened.file < 0 || ::fstat(opened.file, &status) != 0) fail();
  const auto there = static_cast<std::size_t>(status.st_size);
  std::string seal(seal_bytes, '\0');
  const ssize_t got = read_at(opened.file, seal.data(), seal.size(), 0);
  if (got < 0) fail();
  if (there == 0) return damaged("the file is empty");
  if (static_cast<std::size_t>(got) < seal_bytes && opening.substr(0, there).starts_with(seal.substr(0, there)))
    return damaged(fmt::format("the file is cut short within its first {} bytes", seal_bytes));
  const std::string text = seal.substr(0, seal_bytes - 17);
  if (seal != sealed(text)) {
    // A file of another program has neither end of a seal; one of ours with a flipped bit has at least one.
    if (!seal.starts_with(opening) && seal.substr(seal_bytes - 22, 5) != "seal ")
      return {SealReport::State::unsealed, "the file has no seal of this program"};
    return damaged(fmt::format("its seal, the first {} bytes", seal_bytes));
  }

  std::size_t bytes = 0;
  const std::size_t number = opening.size() + 6; // after "bytes "
  std::from_chars(seal.data() + number, seal.data() + seal.size(), bytes);
  if (there < bytes) return damaged(fmt::format("the file is cut short: {} of {} bytes are there", there, bytes));
  if (there > bytes) return damaged(fmt::format("the file has {} bytes after its end at {}", there - bytes, bytes));
  const auto digests = digests_of(opened.file, bytes);
  if (!digests) fail();
  if (text_of(bytes, *digests) == text) return {SealReport::State::whole, ""};
  const std::size_t part = part_for(bytes);
  for (std::size_t k = 0; k < digests->size(); ++k) {
    const std::size_t line = heading(bytes).size() + k * ((*digests)[k].size() + 1);
    if (text.compare(line, (*digests)[k].size(), (*digests)[k]) != 0)
      return damaged(
          fmt::format("between byte {} and byte {}", std::max(k * part, seal_bytes), std::min(bytes, (k + 1) * part)));
  }
  return damaged("its seal does not fit the file");
}

} // namespace grandamp::hdf5
