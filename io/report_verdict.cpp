#include "io/report_verdict.hpp"

#include "io/json.hpp"
#include "io/report_data.hpp"
#include "solver/guards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grandamp::report {
namespace {

std::string percent(double share) {
  return fmt::format("{:.2g} %", 100.0 * share);
}

/// Between backquotes stands what is typed.
std::string with_code(const std::string& text) {
  std::string html;
  bool code = false;
  for (const char c : escaped(text)) {
    if (c != '`') {
      html += c;
      continue;
    }
    html += code ? "</code>" : "<code>";
    code = !code;
  }
  return html + (code ? "</code>" : "");
}

class Watch {
public:
  explicit Watch(const RunFacts& run) : run_(run), summary_(run.summary) {}

  std::vector<Caution> cautions() {
    ending();
    granules();
    if (!summary_.is_null()) {
      energy();
      search();
      response();
    }
    sampling();
    add(Doubt::none, "One run has no error bars.",
        "Granules move chaotically: another seed gives other numbers. `grandamp sweep SCENE --seeds 5` tells how "
        "much.");
    std::stable_sort(found_.begin(), found_.end(), [](const Caution& a, const Caution& b) {
      return static_cast<int>(a.doubt) > static_cast<int>(b.doubt);
    });
    return found_;
  }

private:
  void add(Doubt doubt, std::string what, std::string so = {}) {
    found_.push_back({doubt, std::move(what), std::move(so)});
  }
  double of(std::string_view path) const { return number(summary_, path); }

  void ending() {
    if (summary_.is_null()) {
      const double planned = run_.scene ? run_.scene->time.duration : not_known;
      add(Doubt::serious,
          fmt::format("The run is not finished: it has no summary. Recorded until {}{}.", readable(run_.end(), "s"),
                      std::isfinite(planned) ? fmt::format(" of {}", readable(planned, "s")) : std::string()),
          "It still goes on, or was killed: then `grandamp resume` finishes it. What follows is what there is.");
      return;
    }
    const std::string status = text(summary_, "status");
    if (status == "done") return;
    add(Doubt::serious,
        fmt::format("The run was {}, at {} of {}.", status, readable(of("duration"), "s"),
                    readable(of("planned_duration"), "s")),
        text(summary_, "message"));
  }

  void granules() {
    if (const double escaped = of("guards/escaped"); escaped > 0.0)
      add(Doubt::serious, fmt::format("{:.0f} granules left the enclosure.", escaped),
          "The step is too long for the speeds met.");
    const double overlap = of("guards/max_overlap");
    if (overlap > overlap_warning)
      add(Doubt::some, fmt::format("The deepest overlap was {} of a radius.", percent(overlap)),
          fmt::format("Hertz's law holds for small ones; beyond {} its force is a guess.", percent(overlap_warning)));
    const double met = of("guards/max_closing_speed"), assumed = of("impact_speed");
    if (met > assumed)
      add(met > 2.0 * assumed ? Doubt::some : Doubt::none,
          fmt::format("A contact closed at {}; the step rests on {}.", readable(met, "m/s", 3),
                      readable(assumed, "m/s", 3)),
          fmt::format("The fastest contacts were followed by {} fewer steps than asked for; set time.impact_speed to "
                      "what was met.",
                      percent(1.0 - std::pow(assumed / met, 0.2))));
  }

  void energy() {
    const double residual = of("energy/residual");
    if (!summary_.contains("energy"))
      add(Doubt::some, "The energy balance was not kept (output.energy = false).",
          "An error of the step would not show in it.");
    else if (!(residual <= residual_wrong))
      add(Doubt::serious, fmt::format("The energy balance is off by {}.", percent(residual)),
          "The step is too long, or something is wrong; raise time.steps_per_contact.");
    else if (residual > residual_doubtful)
      add(Doubt::some, fmt::format("The energy balance is off by {}.", percent(residual)),
          "Losses are no better known than that; raise time.steps_per_contact.");
    else
      add(Doubt::none, fmt::format("The energy balance closes within {}.", percent(residual)));
  }

  void search() {
    const double missed = of("verlet/missed"), audited = of("verlet/audited");
    if (missed > 0.0)
      add(Doubt::some,
          fmt::format("{:.0f} contacts began without being listed, for {:.0f} pair-steps in all.", missed,
                      of("verlet/missed_pair_steps")),
          fmt::format("Found by comparing {:.0f} steps with all pairs; verlet.policy = \"guarded\" misses none.",
                      audited));
    else if (audited > 0.0)
      add(Doubt::none, fmt::format("No contact was missed in {:.0f} steps compared with all pairs.", audited));
    else if (run_.scene &&
             (run_.scene->verlet.policy == ListPolicy::predicted || run_.scene->verlet.policy == ListPolicy::fixed))
      add(Doubt::some, "The list policy can miss contacts, and nobody looked.",
          "Set verlet.audit, or verlet.policy = \"guarded\".");
  }

  void response() {
    if (!summary_.contains("structure")) return;
    const std::array<double, 2> window = run_.window();
    if (!std::isfinite(of("structure/amplitude"))) {
      add(Doubt::serious,
          "There is no amplitude: the run did not come to its window of statistics, or no whole cycle lies in it.");
      return;
    }
    const double periods = (std::min(window[1], run_.end()) - window[0]) * run_.forcing_frequency();
    if (!summary_["structure"].value("steady", false) && run_.scene &&
        run_.scene->excitation.kind == ExcitationKind::none)
      add(Doubt::none, "Free vibration: the amplitude falls, and its mean over the window depends on the window.");
    else if (!summary_["structure"].value("steady", false))
      add(Doubt::some, "Not steady: the amplitude still drifts over the window by more than it scatters.",
          "Its mean says little; run longer, or let the window begin later.");
    else
      add(Doubt::none, "Steady: over the window the amplitude drifts by less than it scatters.");
    if (periods < fewest_periods - 1e-6)
      add(Doubt::some, fmt::format("The window holds only {:.3g} periods.", periods),
          fmt::format("A mean over fewer than {:.0f} is uncertain; run longer.", fewest_periods));
  }

  void sampling() {
    const std::vector<double>& time = *run_.column("time");
    if (time.size() < 2) return;
    const double rows =
        1.0 / (run_.forcing_frequency() * (time.back() - time.front()) / static_cast<double>(time.size() - 1));
    if (rows < fewest_rows)
      add(Doubt::some, fmt::format("The histories have {:.2g} rows in a period.", rows),
          "Their peaks are cut; the amplitude and rms above are not, they rest on every step. Lower "
          "output.history_interval.");
  }

  const RunFacts& run_;
  const Json& summary_;
  std::vector<Caution> found_;
};

} // namespace

std::vector<Caution> cautions_of(const RunFacts& run) {
  return Watch(run).cautions();
}

void add_verdict(Page& page, const RunFacts& run) {
  struct Words {
    const char* style;
    const char* mark;
    const char* text;
  };
  static constexpr Words words[] = {{"fine", "✓", "Nothing was found that speaks against these numbers"},
                                    {"careful", "!", "Read with care"},
                                    {"wrong", "✕", "Do not rely on these numbers"}};
  const std::vector<Caution> cautions = cautions_of(run);
  const Words& all = words[static_cast<int>(cautions.front().doubt)];
  page.section("verdict", "Verdict");
  std::string html = fmt::format("<div class=\"verdict {}\"><p class=\"headline\"><span class=\"mark\" "
                                 "aria-hidden=\"true\">{}</span> {}</p>\n<ul>\n",
                                 all.style, all.mark, all.text);
  for (const Caution& caution : cautions) {
    const Words& one = words[static_cast<int>(caution.doubt)];
    html += fmt::format("<li class=\"{}\"><strong>{}</strong> {}</li>\n", one.style, with_code(caution.what),
                        with_code(caution.so));
  }
  page.add(html + "</ul></div>\n");
}

} // namespace grandamp::report
