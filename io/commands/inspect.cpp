#include "io/inspect.hpp"
#include "io/commands/commands.hpp"

#include <spdlog/spdlog.h>

namespace grandamp {

int inspect_command(const InspectArguments& arguments) {
  const Inspection inspection = inspect(arguments.file);
  tell(inspection.text);
  if (!inspection.whole) spdlog::error("{}: is not known to be whole", arguments.file.string());
  return inspection.whole ? exit_done : exit_file;
}

} // namespace grandamp
