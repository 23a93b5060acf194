// How far many runs are: one updating line on a terminal, a line every half minute in a log.
#pragma once

#include "io/case_options.hpp"

#include <string>

namespace grandamp {

class CaseProgressPrinter {
public:
  explicit CaseProgressPrinter(bool quiet);
  /// Stands before what follows: "evaluation 3 of 20: ".
  void head(const std::string& text) { head_ = text; }
  void show(const CaseProgress& progress);
  /// Takes the line off the terminal, so that a message has it to itself.
  void clear();

private:
  bool quiet_, terminal_, on_screen_ = false;
  double told_ = 0.0, shown_ = -1.0;
  std::string head_;
};

} // namespace grandamp
