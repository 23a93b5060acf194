#include "io/study_report.hpp"

#include "io/json.hpp"
#include "io/progress.hpp"
#include "io/version.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grandamp {

namespace {

std::string percent(double value) {
  return fmt::format("{:.2g} %", 100.0 * value);
}

std::string signed_percent(double value) {
  return fmt::format("{:+.2g} %", 100.0 * value);
}

std::string difference_text(const StudyDifference& difference) {
  if (std::isnan(difference.standard_error)) return signed_percent(difference.relative) + " (scatter not known)";
  return fmt::format("{} ± {}{}", signed_percent(difference.relative), percent(resolved_at * difference.standard_error),
                     difference.resolved() ? "" : ", not told from chance");
}

/// The steps of the ladder, each with what the next finer one costs.
std::string halving_text(const StudyTable& table) {
  std::string text;
  const StudyRow* before = nullptr;
  for (const StudyRow& row : table.rows) {
    if (row.setting->group != "steps" || row.runs == 0 || row.setting->name == "own") continue;
    text += fmt::format(
        "{}{}: {} s{}, a contact is off by {}", text.empty() ? "" : "; ", row.setting->label,
        fmt::format("{:.3g}", row.time),
        before != nullptr && before->time > 0.0 ? fmt::format(" ({:.2f} times)", row.time / before->time) : "",
        percent(row.setting->contact.error));
    before = &row;
  }
  return text;
}

std::string csv_field(const std::string& text) {
  std::string quoted(1, '"');
  for (const char c : text) {
    if (c == '"') quoted += c;
    quoted += c;
  }
  return quoted += '"';
}

} // namespace

std::string StudyReport::paragraph() const {
  const StudyAdvice advice = advise(*table, error);
  if (table->reference == nullptr || advice.by_observables == nullptr) return "";
  const StudyRow& best = *advice.by_observables;
  const auto seeds = [](int count) { return fmt::format("{} seed{}", count, count == 1 ? "" : "s"); };
  std::string text = fmt::format("For an error of {}: {}", percent(error), best.setting->label);
  if (best.setting->own) text += " (the scene's own settings)";
  if (advice.seeds_needed > 0)
    text += fmt::format(
        ", as far as {} of this length can tell: they tell nothing below {} from chance, and about {} would "
        "be needed",
        seeds(table->seeds), percent(best.scatter()), seeds(advice.seeds_needed));
  if (table->own != nullptr && !best.setting->own && table->own->time > 0.0)
    text += fmt::format("; {:.2f} times the time of the scene's own settings", best.time / table->own->time);
  text += fmt::format(". Held against {} in double, guarded, over {}:", table->reference->setting->label,
                      seeds(table->seeds));
  bool first = true;
  for (const StudyDifference& difference : best.differences) {
    if (!is_main(difference.observable)) continue;
    text += fmt::format("{} {} {}", first ? "" : ",", in_words(difference.observable), difference_text(difference));
    first = false;
  }
  text += fmt::format(" (± three standard errors of the seeds' scatter). A single contact is off by {} there ({})",
                      percent(best.setting->contact.error), best.setting->contact.contact);
  if (advice.by_contact != nullptr)
    text += fmt::format("; every contact within {} takes {}, {:.3g} s instead of {:.3g} s a run, which is what [time] "
                        "error goes by",
                        percent(error), advice.by_contact->setting->label, advice.by_contact->time, best.time);
  text += '.';
  if (std::isnan(best.scatter()))
    text += " With one seed the scatter is not known: no difference can be told from chance; use --seeds 3 or more.";
  if (done < planned) text += fmt::format(" Of {} runs {} are done.", planned, done);
  return text;
}

std::string StudyReport::csv() const {
  std::string text = "setting,group,label,overrides,own,reference,runs,stopped,steps_per_contact,time_step,time,"
                     "time_spread,wall_time,granule_steps_per_second,contact_error,restitution_mean,"
                     "restitution_deviation,restitution_exact,energy_residual,max_overlap,missed,audited_time";
  const std::vector<StudyDifference> none;
  const std::vector<StudyDifference>& names = table->reference != nullptr ? table->reference->differences : none;
  for (const StudyDifference& one : names)
    text += fmt::format(",{0},{0}_difference,{0}_standard_error", one.observable);
  text += '\n';
  for (const StudyRow& row : table->rows) {
    const StudySetting& setting = *row.setting;
    text += fmt::format(
        "{},{},{},{},{:d},{:d},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", setting.name, setting.group,
        csv_field(setting.label), csv_field(fmt::format("{}", fmt::join(setting.overrides, " "))), setting.own,
        setting.reference, row.runs, csv_field(row.stopped), setting.steps_per_contact, setting.time_step, row.time,
        row.time_spread, row.wall_time, row.rate, setting.contact.error, setting.restitution.mean,
        setting.restitution.deviation, setting.restitution.exact, row.residual, row.max_overlap,
        row.audited ? fmt::format("{}", row.missed) : "", row.audited ? fmt::format("{}", row.audited_time) : "");
    for (const StudyDifference& name : names) {
      const StudyDifference* one = row.find(name.observable);
      text += one != nullptr ? fmt::format(",{},{},{}", one->mean, one->relative, one->standard_error) : ",,,";
    }
    text += '\n';
  }
  return text;
}

std::string StudyReport::json() const {
  const StudyAdvice advice = advise(*table, error);
  const auto name_or_null = [](const StudyRow* row) {
    return row != nullptr ? Json(row->setting->name) : Json(nullptr);
  };
  Json json{{"title", title}, {"version", version()}, {"isa", isa}};
  json["runs"] = {{"done", done}, {"planned", planned}, {"seeds", table->seeds}};
  json["threads"] = {{"cases", threads.cases}, {"each", threads.each}};
  json["error"] = error;
  json["recommended"] = {{"by_observables", name_or_null(advice.by_observables)},
                         {"by_contact", name_or_null(advice.by_contact)},
                         {"text", paragraph()}};
  json["left_out"] = settings->left_out;
  json["frontier"] = Json::array();
  for (const StudyRow* row : frontier(*table)) json["frontier"].push_back(row->setting->name);
  json["settings"] = Json::array();
  for (const StudyRow& row : table->rows) {
    const StudySetting& setting = *row.setting;
    Json one{{"name", setting.name},
             {"group", setting.group},
             {"label", setting.label},
             {"overrides", setting.overrides},
             {"own", setting.own},
             {"reference", setting.reference},
             {"runs", row.runs},
             {"stopped", row.stopped},
             {"steps_per_contact", setting.steps_per_contact},
             {"time_step", setting.time_step},
             {"time", row.time},
             {"time_spread", row.time_spread},
             {"wall_time", row.wall_time},
             {"granule_steps_per_second", row.rate},
             {"contact_error", setting.contact.error},
             {"contact", setting.contact.contact},
             {"restitution",
              {{"mean", setting.restitution.mean},
               {"deviation", setting.restitution.deviation},
               {"exact", setting.restitution.exact}}},
             {"energy_residual", row.residual},
             {"max_overlap", row.max_overlap}};
    if (row.audited)
      one["audit"] = {{"missed", row.missed}, {"steps_compared", row.audited_steps}, {"time", row.audited_time}};
    for (const StudyDifference& difference : row.differences)
      one["observables"][difference.observable] = {{"mean", difference.mean},
                                                   {"difference", difference.relative},
                                                   {"standard_error", json_number(difference.standard_error)},
                                                   {"resolved", difference.resolved()}};
    json["settings"].push_back(std::move(one));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string StudyReport::markdown() const {
  std::string text = fmt::format("# What accuracy costs in time: {}\n\n{}\n\n", title, paragraph());
  text += fmt::format(
      "{} of {} runs, {} seed{}; {}; {} at a time, {} thread{} each; grandamp {}. Every setting is run once per seed, "
      "all "
      "settings of a seed in turn from the same granules, so that a busy machine favours none. Time is {} of the "
      "steps, "
      "pouring left out, ledger on: the median over seeds of its share of the own settings' time in the same turn, "
      "times "
      "the median of theirs. Error of a contact: what its final velocities and spins are off by, as the root of their "
      "kinetic energy over the impact's, root mean square over the phases of entry, of the worst contact and impact. "
      "Differences are means over seeds against the reference, ± three standard errors of the scatter between seeds; "
      "in "
      "brackets where they are not told from chance.\n\n",
      done, planned, table->seeds, table->seeds == 1 ? "" : "s", isa, threads.cases, threads.each,
      threads.each == 1 ? "" : "s", version(), threads.each == 1 ? "processor time" : "wall time");
  text += "![error of a contact against time](error_time.svg)\n![error of the observables against "
          "time](response_time.svg)\n"
          "![rate against step](rate_step.svg)\n![missed contacts against policy](missed_policy.svg)\n\n";
  std::vector<std::string> names;
  if (table->reference != nullptr)
    for (const StudyDifference& one : table->reference->differences) names.push_back(one.observable);
  text += "| setting | time, s | of own | error of a contact | restitution |";
  for (const std::string& name : names) text += fmt::format(" {} |", in_words(name));
  text += " left of the energy | missed |\n|";
  for (std::size_t k = 0; k < names.size() + 7; ++k) text += " --- |";
  text += '\n';
  for (const StudyRow& row : table->rows) {
    const StudySetting& setting = *row.setting;
    text +=
        fmt::format("| {}{}{} ", setting.label, setting.own ? " **own**" : "", setting.reference ? " (reference)" : "");
    if (row.runs == 0) {
      text += fmt::format("| {} |\n", row.stopped.empty() ? "not run yet" : "stopped: " + row.stopped);
      continue;
    }
    text += fmt::format("| {:.3g} ± {:.0f} % | {} | {} | {:.4f} ± {:.4f} |", row.time, 100.0 * row.time_spread,
                        table->own != nullptr ? fmt::format("{:.2f}", row.time / table->own->time) : "-",
                        percent(setting.contact.error), setting.restitution.mean, setting.restitution.deviation);
    for (const std::string& name : names) {
      const StudyDifference* one = row.find(name);
      if (one == nullptr)
        text += " - |";
      else if (setting.reference)
        text += fmt::format(" {:.4g} ± {} |", one->mean, percent(resolved_at * one->standard_error));
      else
        text += one->resolved() ? fmt::format(" {} ± {} |", signed_percent(one->relative),
                                              percent(resolved_at * one->standard_error))
                                : fmt::format(" ({} ± {}) |", signed_percent(one->relative),
                                              percent(resolved_at * one->standard_error));
    }
    text += fmt::format(" {} | {} |\n", percent(row.residual),
                        row.audited ? fmt::format("{} in {:.3g} s", row.missed, row.audited_time) : "");
  }
  text += "\nWhat finer steps cost: " + halving_text(*table) + ".\n";
  if (!settings->left_out.empty()) {
    text += "\nLeft out:\n\n";
    for (const std::string& one : settings->left_out) text += fmt::format("- {}\n", one);
  }
  text += "\nThe settings, as overrides of the scene (--set):\n\n";
  for (const StudyRow& row : table->rows)
    text += fmt::format("- {}: {}\n", row.setting->label,
                        row.setting->overrides.empty() ? "none"
                                                       : fmt::format("{}", fmt::join(row.setting->overrides, ", ")));
  return text;
}

} // namespace grandamp
