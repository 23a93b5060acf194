#include "io/text_file.hpp"

#include "solver/errors.hpp"

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

namespace grandamp {

TextFile::TextFile(const std::filesystem::path& path) : path_(path), file_(std::fopen(path.c_str(), "wb")) {
  if (file_ == nullptr) fail("create");
}

TextFile::~TextFile() {
  if (file_ != nullptr) std::fclose(file_);
}

void TextFile::fail(const char* what) const {
  throw FileError(path_.string() + ": cannot " + what + " the file: " + std::strerror(errno));
}

void TextFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail("write");
}

void TextFile::close() {
  if (std::fclose(std::exchange(file_, nullptr)) != 0) fail("write");
}

void replace_file(const std::filesystem::path& path, std::string_view text) {
  replace_file(path, text, ".new");
}

void replace_file(const std::filesystem::path& path, std::string_view text, std::string_view ending) {
  std::filesystem::path beside = path;
  beside += ending;
  std::error_code error;
  try {
    TextFile file(beside);
    file.write(text);
    file.close();
  } catch (...) {
    std::filesystem::remove(beside, error);
    throw;
  }
  std::filesystem::rename(beside, path, error);
  if (error) {
    const std::string reason = error.message();
    std::filesystem::remove(beside, error);
    throw FileError(path.string() + ": cannot replace the file: " + reason);
  }
}

} // namespace grandamp
