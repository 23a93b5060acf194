// What commands that make many runs (sweeps, searches, studies) are asked, whatever they make of them.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace grandamp {

struct CaseProgress {
  std::size_t done = 0, running = 0, all = 0;
  double seconds = 0.0; ///< since it began
  double left = -1.0;   ///< s; below 0: not known yet
};

struct CaseOptions {
  int seeds = 1;                                   ///< runs of each point, design or setting, from the scene's seed on
  int threads = 0;                                 ///< in all; 0: what the process may use
  std::string isa;                                 ///< empty: the best
  double max_wall = 0.0;                           ///< s after which it stops as if interrupted; 0: no end
  bool force = false;                              ///< replace what the folder holds
  std::function<void(const std::string&)> tell;    ///< what will be run, and what is left out
  std::function<void(const std::string&)> warning; ///< a case that failed, as the work goes
  std::function<void(const CaseProgress&)> progress;
  std::function<bool()> stop_requested; ///< asked often, by several threads
};

} // namespace grandamp
