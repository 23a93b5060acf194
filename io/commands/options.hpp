// The options that commands have in common, and those of the commands that have many.
#pragma once

#include "io/commands/commands.hpp"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace grandamp {

void add_overrides(CLI::App& command, std::vector<std::string>& overrides);
void add_threads(CLI::App& command, int& threads);
void add_isa(CLI::App& command, std::string& isa);
void add_quiet(CLI::App& command, bool& quiet);

void add_study(CLI::App& command, StudyArguments& study);
void add_sweep(CLI::App& command, SweepArguments& sweep);
void add_optimise(CLI::App& command, OptimiseArguments& optimise);

} // namespace grandamp
