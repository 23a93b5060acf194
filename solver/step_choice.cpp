#include "solver/step_choice.hpp"

#include "solver/errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace grandamp {

namespace {

constexpr std::array<double, 26> ladder{4,  5,  6,  7,  8,  10, 12, 14,  16,  20,  24,  28,  32,
                                        40, 48, 56, 64, 72, 80, 96, 112, 128, 160, 192, 224, 256};
/// A contact closing at a thousandth of the speed lasts four times as long.
constexpr double slower_contacts = 4.0;

/// Errors on the ladder, worked out when asked for.
class Errors {
public:
  Errors(const ContactCalibration& calibration, Integrator integrator, const std::function<double(double)>& step_at)
      : calibration_(calibration), integrator_(integrator), step_at_(step_at) {}

  const ContactError& at(std::size_t rung) {
    if (!known_[rung]) known_[rung] = calibration_.error_at(step_at_(ladder[rung]), integrator_);
    return *known_[rung];
  }

  /// The largest at a rung and at those that stand for its slower contacts.
  ContactError worst(std::size_t rung) {
    ContactError worst = at(rung);
    for (std::size_t finer = rung + 1; finer < ladder.size() && ladder[finer] <= slower_contacts * ladder[rung];
         ++finer)
      if (at(finer).error > worst.error) worst = at(finer);
    return worst;
  }

private:
  const ContactCalibration& calibration_;
  Integrator integrator_;
  const std::function<double(double)>& step_at_;
  std::array<std::optional<ContactError>, ladder.size()> known_;
};

const char* name(Integrator integrator) {
  return integrator == Integrator::verlet ? "velocity Verlet" : "leapfrog";
}

} // namespace

std::string StepChoice::reason() const {
  std::string text = fmt::format("for error = {:g} the fewest steps in a contact are {:g}, with {}: error {:.2g} ({})",
                                 asked, steps_per_contact, name(integrator), error, contact);
  if (coarser_steps > 0.0)
    text += fmt::format("; {:g} steps would give {:.2g} ({})", coarser_steps, coarser_error, coarser_contact);
  return text;
}

StepChoice choose_steps(const Scene& scene, const std::vector<ContactKind>& kinds, double impact_speed,
                        const std::function<double(double)>& step_at) {
  const double asked = *scene.time.error;
  const ContactCalibration calibration(scene.contact, kinds, impact_speed);
  std::vector<Integrator> integrators{scene.time.integrator};
  if (scene.time.integrator_free) integrators = {Integrator::leapfrog, Integrator::verlet};
  std::vector<Errors> errors;
  errors.reserve(integrators.size());
  for (const Integrator integrator : integrators) errors.emplace_back(calibration, integrator, step_at);

  StepChoice choice;
  choice.asked = asked;
  ContactError least{1.0e300, ""};
  for (std::size_t rung = 0; rung < ladder.size(); ++rung) {
    for (std::size_t k = 0; k < integrators.size(); ++k) {
      // Most rungs are out by themselves; those that are not are looked at with the finer ones.
      ContactError worst = errors[k].at(rung);
      if (worst.error <= asked) worst = errors[k].worst(rung);
      if (worst.error <= asked) {
        choice.steps_per_contact = ladder[rung];
        choice.integrator = integrators[k];
        choice.error = worst.error;
        choice.contact = worst.contact;
        return choice;
      }
      if (k == 0) {
        choice.coarser_steps = ladder[rung];
        choice.coarser_error = worst.error;
        choice.coarser_contact = worst.contact;
      }
      if (worst.error < least.error) least = worst;
    }
  }
  throw SceneError(Problem{"time.error", fmt::format("{:g}", asked),
                           fmt::format("not reached with {:g} steps in a contact, where {} is off by {:.2g}",
                                       ladder.back(), least.contact, least.error),
                           fmt::format("at least {:.1g}, or steps_per_contact", 1.1 * least.error)});
}

} // namespace grandamp
