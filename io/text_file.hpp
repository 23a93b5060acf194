// Text files that tell of every failure.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string_view>

namespace grandamp {

/// A file being written. Every member throws FileError with the path and the system's reason.
class TextFile {
public:
  /// Replaces a file that exists.
  explicit TextFile(const std::filesystem::path& path);
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;
  ~TextFile();

  void write(std::string_view text);
  /// The last of it is written only here.
  void close();

private:
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path path_;
  std::FILE* file_;
};

/// The whole file or, on an error, what was there before.
void replace_file(const std::filesystem::path& path, std::string_view text);
/// `ending`: of the name under which it is written first.
void replace_file(const std::filesystem::path& path, std::string_view text, std::string_view ending);

} // namespace grandamp
