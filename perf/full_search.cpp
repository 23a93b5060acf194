// Steps without a list, by the plain link-cell search of the textbooks: every granule looks through all 27 cells about
// it, so that each pair is found from both sides, at every step. Kept here alone, to be compared with; forces, walls,
// structure and motion are the program's own. `--search half` looks through half of the cells in the same way: how it
// compares with the program's own policy "none" tells what this driver adds. Prints one JSON object.
#include "io/scene_file.hpp"
#include "kernels/dispatch.hpp"
#include "perf/timing.hpp"
#include "solver/cell_grid.hpp"
#include "solver/enclosure_motion.hpp"
#include "solver/material.hpp"
#include "solver/measures.hpp"
#include "solver/packing.hpp"
#include "solver/walls.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>

namespace {

using namespace grandamp;

class Driver {
public:
  Driver(const Plan& plan, bool full)
      : plan_(plan), full_(full), walls_(make_walls(plan.scene.enclosure)), size_(bounding_box(plan.scene.enclosure)),
        motion_(plan.scene, plan.time_step),
        granules_(plan.granules, {.shares = plan.scene.contact.friction == FrictionLaw::coulomb}) {
    const Contact& contact = plan.scene.contact;
    kernels::ContactEffects effects;
    effects.damping = contact.damping == NormalDamping::tsuji    ? kernels::Damping::tsuji
                      : contact.damping == NormalDamping::linear ? kernels::Damping::linear
                                                                 : kernels::Damping::none;
    effects.friction = contact.friction == FrictionLaw::none ? kernels::Friction::none
                       : contact.rotation                    ? kernels::Friction::coulomb
                                                             : kernels::Friction::coulomb_without_rotation;
    const kernels::InstructionSet set = kernels::best_available();
    pair_ = kernels::pair_kernel_for(set, effects);
    plane_ = kernels::plane_kernel_for(set, effects);
    side_ = kernels::side_kernel_for(set, effects);
    move_ = kernels::motion_kernel_for(set, {.rubbing = effects.rotates()  ? kernels::Rubbing::with_rotation
                                                        : effects.counts() ? kernels::Rubbing::without_rotation
                                                                           : kernels::Rubbing::none});
    search_ = kernels::candidate_kernel_for(set, true);
    const ContactTable table = make_contact_table(plan.scene);
    const auto row = [&](const ContactLaw& law) {
      return kernels::LawRow{law.stiffness_coefficient,
                             contact.damping == NormalDamping::linear ? law.normal_damping : law.alpha, law.friction,
                             0.0};
    };
    pair_law_ = row(table.granule.front());
    wall_law_ = row(table.wall.front());
    friction_cap_ = (effects.rotates() ? 2.0 / 7.0 : 1.0) / plan.time_step;
    place(place_granules(plan));
    enclosure_ = motion_.start(0.0);
  }

  void step() {
    find_pairs();
    kernels::ContactResult contacts;
    const double reaction = wall_forces();
    const EnclosureStep enclosure = motion_.advance(enclosure_, step_number_++, reaction);
    kernels::PairArguments a;
    a.granules = granules_.arrays();
    a.pairs = pairs_.data();
    a.count = pairs_.size() - kernels::list_padding;
    a.touching = touching_.data();
    a.law = pair_law_;
    a.radius = plan_.largest_radius;
    a.mass = 1.0 / granules_.motion[0].inverse_mass;
    a.friction_cap = friction_cap_;
    pair_(a, contacts);
    kernels::MotionArguments m;
    m.granules = a.granules;
    m.last = granules_.count();
    m.time_step = plan_.time_step;
    for (std::size_t k = 0; k < 3; ++k)
      m.kick[k] = plan_.scene.gravity[k] * plan_.time_step -
                  (enclosure.velocity_after - enclosure.velocity_before) * motion_.direction()[k];
    kernels::MotionResult moved;
    move_(m, moved);
  }

  std::size_t pairs_found() const { return found_; }

private:
  void place(const Placement& start) {
    const double frame = motion_.initial_velocity();
    for (std::uint32_t i = 0; i < granules_.count(); ++i) {
      granules_.position[i] = {start.position[i][0], start.position[i][1], start.position[i][2], start.radius[i]};
      for (std::size_t k = 0; k < 3; ++k) {
        granules_.motion[i].velocity[k] = start.velocity[i][k] - frame * motion_.direction()[k];
        granules_.motion[i].surface_spin[k] = start.radius[i] * start.spin[i][k];
      }
      granules_.motion[i].inverse_mass = 1.0 / start.mass[i];
      granules_.motion[i].inverse_radius = 1.0 / start.radius[i];
      granules_.id[i] = i;
      granules_.population[i] = 0;
    }
    granules_.set_ghosts();
    // Vectors may read past the end.
    for (auto* coordinate : {&x_, &y_, &z_}) coordinate->assign(granules_.count() + kernels::list_padding, 0.0);
    touching_.resize(kernels::contact_scratch);
    touching_wall_.resize(kernels::contact_scratch);
  }

  void find_pairs() {
    const double reach = 2.0 * plan_.largest_radius;
    grid_.sort(granules_, make_grid_shape(size_, reach, granules_.count()), team_);
    granules_.clear_forces(0, granules_.count());
    for (std::uint32_t i = 0; i < granules_.count(); ++i) {
      x_[i] = granules_.position[i].x;
      y_[i] = granules_.position[i].y;
      z_[i] = granules_.position[i].z;
    }
    kernels::CandidateArguments a;
    a.x = x_.data();
    a.y = y_.data();
    a.z = z_.data();
    a.reach = reach;
    const GridShape& shape = grid_.shape();
    std::size_t kept = 0;
    found_ = 0;
    for (int slow = 0; slow < shape.cells[2]; ++slow)
      for (int middle = 0; middle < shape.cells[1]; ++middle)
        for (int fast = 0; fast < shape.cells[0]; ++fast) kept = search_cell(a, fast, middle, slow, kept);
    pairs_.resize(kept);
    while (pairs_.size() % kernels::list_padding != 0)
      pairs_.push_back(kernels::RowPair::of(granules_.count(), granules_.count() + 1));
    pairs_.resize(pairs_.size() + kernels::list_padding); // room that vectors may read
  }

  std::size_t search_cell(const kernels::CandidateArguments& a, int fast, int middle, int slow, std::size_t kept) {
    const GridShape& shape = grid_.shape();
    const int low = std::max(fast - 1, 0), high = std::min(fast + 1, shape.cells[0] - 1);
    const auto end_of = [&](int f, int m, int s) { return grid_.start()[grid_.index(f, m, s) + 1]; };
    const kernels::IndexRange own{grid_.cell_start(fast, middle, slow), end_of(fast, middle, slow)};
    if (own.first == own.last) return kept;
    std::array<kernels::IndexRange, 9> ranges;
    int count = 0;
    std::size_t room = kernels::list_padding;
    for (int s = std::max(slow - (full_ ? 1 : 0), 0); s <= std::min(slow + 1, shape.cells[2] - 1); ++s)
      for (int m = std::max(middle - 1, 0); m <= std::min(middle + 1, shape.cells[1] - 1); ++m) {
        if (!full_ && s == slow && m <= middle) continue; // the own row's second half is own_end's
        ranges[static_cast<std::size_t>(count)] = {grid_.cell_start(low, m, s), end_of(high, m, s)};
        room += ranges[static_cast<std::size_t>(count)].last - ranges[static_cast<std::size_t>(count)].first +
                kernels::list_padding;
        ++count;
      }
    room = (room + end_of(high, middle, slow) - own.first) * (own.last - own.first);
    if (pairs_.size() < kept + room) pairs_.resize(2 * (kept + room));
    kernels::RowPair* const from = pairs_.data() + kept;
    const kernels::RowPair* const end =
        search_(a, own, full_ ? 0 : end_of(high, middle, slow), ranges.data(), count, from);
    found_ += static_cast<std::size_t>(end - from);
    if (!full_) return kept + static_cast<std::size_t>(end - from);
    // Both sides have found the pair (and each granule itself): one of them keeps it.
    for (const kernels::RowPair* pair = from; pair != end; ++pair)
      if (pair->first_offset < pair->second_offset) pairs_[kept++] = *pair;
    return kept;
  }

  double wall_forces() {
    kernels::WallArguments a;
    a.granules = granules_.arrays();
    a.touching = touching_wall_.data();
    a.law = wall_law_;
    a.friction_cap = friction_cap_;
    std::copy_n(motion_.direction().begin(), 3, a.direction);
    double reaction = 0.0;
    for (const Wall& wall : walls_) {
      near_.clear();
      for (std::uint32_t i = 0; i < granules_.count(); ++i)
        if (distance_inside(wall, granules_.position[i]) < plan_.largest_radius) near_.push_back(i);
      a.count = near_.size();
      if (a.count == 0) continue;
      while (near_.size() % kernels::list_padding != 0) near_.push_back(granules_.count());
      a.surface = wall.surface;
      a.list = near_.data();
      kernels::WallResult result;
      (wall.side ? side_ : plane_)(a, result);
      for (std::size_t k = 0; k < 3; ++k) reaction -= result.force[k] * motion_.direction()[k];
    }
    return reaction;
  }

  const Plan& plan_;
  bool full_;
  std::vector<Wall> walls_;
  Vector3 size_;
  EnclosureMotion motion_;
  EnclosureState enclosure_;
  std::int64_t step_number_ = 0;
  Granules granules_;
  CellGrid grid_;
  Team team_{1};
  kernels::PairKernel* pair_;
  kernels::WallKernel *plane_, *side_;
  kernels::MotionKernel* move_;
  kernels::CandidateKernel* search_;
  kernels::LawRow pair_law_{}, wall_law_{};
  double friction_cap_ = 0.0;
  std::vector<double> x_, y_, z_;
  std::vector<kernels::RowPair> pairs_;
  std::vector<kernels::RowPair> touching_;
  std::vector<std::uint32_t> near_, touching_wall_;
  std::size_t found_ = 0;
};

} // namespace

int main(int argc, char** argv) {
  CLI::App app("Steps with a plain link-cell search");
  std::string file, search = "full";
  std::vector<std::string> overrides;
  std::int64_t warm = 0, steps = 1000;
  int windows = 1;
  app.add_option("scene", file, "Scene file")->required();
  app.add_option("--set", overrides, "KEY=VALUE")->allow_extra_args(false);
  app.add_option("--search", search, "full: 27 cells; half: 14")->check(CLI::IsMember({"full", "half"}));
  app.add_option("--warm", warm, "Steps before the clock starts");
  app.add_option("--steps", steps, "Steps that are timed");
  app.add_option("--windows", windows, "Times to do it, each from the start");
  CLI11_PARSE(app, argc, argv);
  try {
    Plan plan = make_plan(grandamp::read_scene(file, overrides).scene);
    std::vector<double> processor;
    std::size_t found = 0;
    for (int window = 0; window < windows; ++window) {
      Driver driver(plan, search == "full");
      for (std::int64_t k = 0; k < warm; ++k) driver.step();
      const perf::Stopwatch watch;
      for (std::int64_t k = 0; k < steps; ++k) driver.step();
      processor.push_back(1e9 * watch.processor() / static_cast<double>(steps));
      found = driver.pairs_found();
    }
    std::printf("%s\n", nlohmann::json({{"granules", plan.granules},
                                        {"processor_ns_per_step", processor},
                                        {"pairs_found_per_granule",
                                         static_cast<double>(found) / static_cast<double>(plan.granules)}})
                            .dump()
                            .c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
  return 0;
}
