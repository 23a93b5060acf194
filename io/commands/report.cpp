#include "io/report.hpp"
#include "io/commands/commands.hpp"

#include <spdlog/spdlog.h>

namespace grandamp {

int report_command(const ReportArguments& arguments) {
  spdlog::info("{}", write_report(arguments.folder).string());
  return exit_done;
}

} // namespace grandamp
