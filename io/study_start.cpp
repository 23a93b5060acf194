#include "io/study_start.hpp"

#include "kernels/dispatch.hpp"
#include "solver/measures.hpp"
#include "solver/packing.hpp"
#include "solver/plan.hpp"
#include "solver/pouring.hpp"
#include "solver/random_numbers.hpp"

#include <utility>

namespace grandamp {

namespace {

constexpr double perturbation = 1e-6; ///< m/s
constexpr std::uint64_t perturbation_stream = 0x57d7;

kernels::InstructionSet set_of(const std::string& name) {
  for (const auto set : {kernels::InstructionSet::generic, kernels::InstructionSet::avx2})
    if (name == kernels::name(set)) return set;
  return name.empty() ? kernels::best_available() : kernels::InstructionSet::avx512;
}

} // namespace

StudyStarts::StudyStarts(const SceneDocument& document, std::string name, std::string isa, int threads,
                         std::function<void()> look)
    : document_(document), name_(std::move(name)), isa_(std::move(isa)), threads_(threads), look_(std::move(look)) {}

std::size_t StudyStarts::granules() const {
  return granule_count(document_.scene);
}

const StudyStarts::Positions& StudyStarts::packed(int seed) {
  const std::lock_guard lock(mutex_);
  const auto known = packed_.find(seed);
  if (known != packed_.end()) return known->second;
  Scene scene = document_.scene;
  scene.seed += static_cast<std::uint64_t>(seed);
  const Plan plan = make_plan(scene);
  Placement placement = place_granules(plan);
  if (placement.to_be_poured)
    pour(plan, placement, set_of(isa_), threads_, [this](const PouringProgress&) { look_(); });
  Positions positions(scene.populations.size());
  for (std::size_t i = 0; i < placement.position.size(); ++i)
    positions[static_cast<std::size_t>(placement.population[i])].push_back(placement.position[i]);
  return packed_.emplace(seed, std::move(positions)).first->second;
}

void StudyStarts::put(Scene& scene, int seed) {
  const Positions& positions = packed(seed);
  scene.seed += static_cast<std::uint64_t>(seed);
  RandomNumbers random(scene.seed, perturbation_stream);
  for (std::size_t a = 0; a < scene.populations.size(); ++a) {
    Population& population = scene.populations[a];
    const bool given = std::exchange(population.placed, true);
    population.positions = positions[a];
    if (!given || seed == 0 || (population.velocities.empty() && population.speed > 0.0)) continue;
    population.velocities.resize(population.count, Vector3{});
    for (Vector3& velocity : population.velocities) {
      const Vector3 direction = random.direction();
      for (std::size_t k = 0; k < 3; ++k) velocity[k] += perturbation * direction[k];
    }
  }
}

} // namespace grandamp
