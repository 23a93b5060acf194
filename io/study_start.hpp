// Where the runs of a study start: every setting from the same granules, packed once per seed. Internal to io.
#pragma once

#include "io/scene_file.hpp"

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace grandamp {

/// Thrown out of whatever a study is at when it is to stop.
struct StudyInterrupted {};

class StudyStarts {
public:
  /// `look` is called now and then while granules are poured; it may throw.
  StudyStarts(const SceneDocument& document, std::string name, std::string isa, int threads,
              std::function<void()> look);

  /// Puts the granules of that seed into a scene under some setting. Several threads may ask at once. Explicit
  /// positions stay; the seeds then differ by velocities of a millionth of a metre per second, which is enough in a
  /// chaotic motion.
  void put(Scene& scene, int seed);
  std::size_t granules() const;

private:
  using Positions = std::vector<std::vector<Vector3>>; ///< by population
  const Positions& packed(int seed);

  const SceneDocument& document_;
  std::string name_, isa_;
  int threads_;
  std::function<void()> look_;
  std::mutex mutex_;
  std::map<int, Positions> packed_;
};

} // namespace grandamp
