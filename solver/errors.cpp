#include "solver/errors.hpp"

namespace grandamp {

namespace {
std::string joined(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += problem.key + ": " + problem.message;
    if (!problem.value.empty()) text += " (" + problem.value + ")";
    if (!problem.allowed.empty()) text += "; allowed: " + problem.allowed;
  }
  return text;
}
} // namespace

SceneError::SceneError(std::vector<Problem> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

} // namespace grandamp
