// What can go wrong, as types: each carries what a person needs to put it right.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace grandamp {

/// One fault of a scene. `key` is the dotted scene key ("granules.0.radius"); the reader of a file adds the line.
struct Problem {
  std::string key;
  std::string value;   ///< as the scene has it; empty if the key is missing
  std::string message; ///< what is wrong
  std::string allowed; ///< what is allowed; may be empty
  int line = 0;        ///< 1-based; 0: not known
  bool note = false;   ///< only worth knowing; the run goes on
};

/// A scene that cannot be run; all its faults at once. Exit status 2.
class SceneError : public std::runtime_error {
public:
  explicit SceneError(std::vector<Problem> problems);
  explicit SceneError(Problem problem) : SceneError(std::vector<Problem>{std::move(problem)}) {}
  const std::vector<Problem>& problems() const noexcept { return problems_; }

private:
  std::vector<Problem> problems_;
};

/// A numerical guard stopped the run. what(): what happened, where, when, and what to change. Exit status 3.
class GuardError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// A file that cannot be read or written. Exit status 4.
class FileError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

} // namespace grandamp
