// A scene file (TOML) to a validated Scene, and back to the text that gives the same scene again.
#pragma once

#include "solver/errors.hpp"
#include "solver/scene.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace grandamp {

/// A scene as read.
struct SceneDocument {
  Scene scene;
  /// The TOML as run. Without overrides and granule files it is the file, byte for byte; otherwise it is written anew
  /// (without the comments): overrides applied, keys that they left idle taken out, and the paths of granule files
  /// absolute, so that it gives the same scene wherever it is put.
  std::string text;
  std::vector<Problem> notes;       ///< worth knowing, not wrong: what an override left idle
  std::map<std::string, int> lines; ///< of every dotted key of the file, 1-based; what an override gave has none
};

/// Reads and checks a scene file. Each override is "KEY=VALUE": a dotted key with list items by index
/// ("granules.0.count=0"), and a TOML value or a bare word.
/// Throws SceneError with all faults, each with key and line; FileError if the file, or nothing but a granule file that
/// it names, cannot be read.
SceneDocument read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The same for a text. `name` stands for the file in messages; relative granule files are looked for beside it.
SceneDocument read_scene_text(std::string text, const std::string& name,
                              const std::vector<std::string>& overrides = {});

/// The line of a dotted key. A key that the file lacks has the line of the table that it belongs to; 0: not known.
int line_of(const SceneDocument& document, std::string_view key);

/// Adds lines to faults that were found later, by the solver, and carry keys alone.
std::vector<Problem> located(const SceneDocument& document, std::vector<Problem> problems);

/// A line per fault: "FILE:LINE: KEY = VALUE: what is wrong; allowed: ...". Always printable, whatever the file holds.
std::string format_problems(const std::string& file, const std::vector<Problem>& problems);

} // namespace grandamp
