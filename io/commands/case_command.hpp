// What the commands that make many runs do alike: read the scene, show how far they are, stop when asked.
#pragma once

#include "io/case_options.hpp"
#include "io/commands/case_progress.hpp"
#include "io/commands/commands.hpp"
#include "io/scene_file.hpp"
#include "io/signals.hpp"

#include <filesystem>
#include <string>

namespace grandamp {

class CaseCommand {
public:
  /// Reads the scene and tells what there is to note. Throws as read_scene does, and UsageError.
  explicit CaseCommand(const CaseArguments& arguments);

  const std::filesystem::path& folder() const noexcept { return folder_; }

  /// work(document, name, folder, options), with what was typed in the options, and a line of progress that is gone
  /// when it ends.
  template <class Options, class Result>
  Result run(Options options,
             Result (*work)(const SceneDocument&, const std::string&, const std::filesystem::path&, const Options&)) {
    fill(options);
    const SignalWatch watch;
    const Cleared cleared{printer_};
    return work(document_, arguments_.scene.string(), folder_, options);
  }

private:
  struct Cleared {
    CaseProgressPrinter& printer;
    ~Cleared() { printer.clear(); }
  };
  void fill(CaseOptions& options);

  const CaseArguments& arguments_;
  SceneDocument document_;
  std::filesystem::path folder_;
  CaseProgressPrinter printer_;
};

} // namespace grandamp
