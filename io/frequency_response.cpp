#include "io/frequency_response.hpp"

#include "io/fourier.hpp"
#include "io/run.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <limits>

namespace grandamp {
namespace {

constexpr double rows_per_period = 8.0; // between rows the record is a cubic
constexpr double left_of_transient = 1e-3;
constexpr double bias_wanted = 0.005;
constexpr double fewest_lines = 8.0;    // across the band
constexpr double power_floor = 1e-3;    // of the force, over its largest: 30 dB, where the band ends
constexpr double power_nothing = 1e-12; // within the band: a line that was not driven

struct Rows {
  double end = 0.0;  ///< s
  double mean = 0.0; ///< between rows, s
  double widest = 0.0;
};

Rows examine(const ResponseHistory& history) {
  const std::vector<double>& time = history.time;
  if (time.size() < 16)
    throw UsageError(fmt::format("no frequency response: the history has {} rows; lengthen time.duration or shorten "
                                 "output.history_interval",
                                 time.size()));
  Rows rows;
  for (std::size_t k = 1; k < time.size(); ++k) {
    if (!(time[k] > time[k - 1])) throw FileError("the history is damaged: its times do not rise");
    rows.widest = std::max(rows.widest, time[k] - time[k - 1]);
  }
  for (std::size_t k = 0; k < time.size(); ++k)
    if (!std::isfinite(history.displacement[k]) || !std::isfinite(history.velocity[k]) ||
        !std::isfinite(history.force[k]))
      throw FileError(fmt::format("the history is damaged: no finite numbers at {} s", time[k]));
  rows.end = time.back();
  rows.mean = (time.back() - time.front()) / static_cast<double>(time.size() - 1);
  return rows;
}

/// What a record can tell of, Hz.
double highest_frequency(const Rows& rows, const ExcitedBand& drive, std::vector<std::string>& notes) {
  const double limit = 1.0 / (rows_per_period * rows.widest);
  if (drive.low >= limit)
    throw UsageError(fmt::format("no frequency response: the force begins at {:g} Hz, and rows {:.3g} s apart tell of "
                                 "frequencies below {:.4g} Hz ({:g} rows per period); shorten output.history_interval",
                                 drive.low, rows.widest, limit, rows_per_period));
  if (std::isfinite(drive.high) && drive.high > limit)
    notes.push_back(fmt::format("cut at {:.4g} Hz, though the force reaches {:g} Hz: output.history_interval leaves "
                                "fewer than {:g} rows per period above",
                                limit, drive.high, rows_per_period));
  return std::min(limit, drive.high);
}

double settling_time(const ResponseHistory& history, const ExcitedBand& drive, const LinearHost& host,
                     const ResponseSettings& settings, std::vector<std::string>& notes) {
  const double end = history.time.back();
  if (settings.settling) {
    if (!(*settings.settling < end))
      throw UsageError(fmt::format("no frequency response: a settling time of {:g} s leaves nothing of a run of {:g} s",
                                   *settings.settling, end));
    return *settings.settling;
  }
  if (drive.method == ResponseMethod::transient) return 0.0;
  const double wanted =
      host.decay_rate > 0.0 ? -std::log(left_of_transient) / host.decay_rate : std::numeric_limits<double>::infinity();
  if (wanted <= end / 3.0) return wanted;
  notes.push_back(fmt::format("settling cut to {:.4g} s, a third of the run: the structure's own free vibration takes "
                              "{:.4g} s to die to a thousandth",
                              end / 3.0, wanted));
  return end / 3.0;
}

class Estimate {
public:
  Estimate(const ResponseHistory& history, const ExcitedBand& drive, const LinearHost& host,
           const ResponseSettings& settings)
      : history_(history), drive_(drive), host_(host), settings_(settings), rows_(examine(history)) {
    result_.method = drive.method;
    result_.host = host;
    high_ = highest_frequency(rows_, drive, result_.notes);
    result_.settling = settling_time(history, drive, host, settings, result_.notes);
  }

  FrequencyResponse make() {
    switch (drive_.method) {
    case ResponseMethod::periodic:
      periods();
      break;
    case ResponseMethod::transient:
      whole();
      break;
    case ResponseMethod::welch:
      welch();
      break;
    }
    return std::move(result_);
  }

private:
  double available() const { return rows_.end - result_.settling; }

  void periods() {
    const double period = drive_.period;
    auto count = std::floor(available() / period + 1e-9);
    if (count < 1.0 && rows_.end >= period) {
      count = 1.0;
      result_.settling = rows_.end - period;
      result_.notes.push_back(
          fmt::format("settling cut to {:.4g} s: the run holds one period of the force after it", result_.settling));
    }
    if (count < 1.0)
      throw UsageError(fmt::format("no frequency response: the run of {:g} s is shorter than one period of the force, "
                                   "{:g} s; lengthen time.duration",
                                   rows_.end, period));
    result_.settling = std::max(0.0, rows_.end - count * period);
    result_.segment = period;
    spectra(SpectralWindow::rectangular, 1.0, count);
    if (count < 2.0)
      result_.notes.emplace_back("one period of the force: no coherence; lengthen time.duration for more");
    finish();
  }

  void whole() {
    result_.segment = available();
    spectra(SpectralWindow::tapered_end, 1.0, 1.0);
    result_.notes.emplace_back("one record of a transient: its coherence would be 1 by construction, and is left out");
    tell_of_what_is_left();
    finish();
  }

  void welch() {
    segment(host_.bandwidth);
    spectra(SpectralWindow::hann, 0.5, 0.0);
    finish();
    // With granules the peak is wider than the bare structure's, and shorter segments give more averages.
    if (!settings_.segment && result_.fit.found && result_.fit.bandwidth() > 1.2 * host_.bandwidth) {
      segment(result_.fit.bandwidth());
      spectra(SpectralWindow::hann, 0.5, 0.0);
      finish();
    }
    if (result_.fit.found) result_.bias = hann_bias(result_.fit.bandwidth(), result_.segment);
    if (std::abs(result_.bias) > 2.0 * bias_wanted)
      result_.notes.push_back(
          fmt::format("the window lowers the peak by about {:.2g} %: segments of {:.4g} s; for 0.5 % take {:.4g} s "
                      "and a run of at least {:.4g} s",
                      -100.0 * result_.bias, result_.segment, wanted_segment(result_.fit.bandwidth()),
                      result_.settling + 4.5 * wanted_segment(result_.fit.bandwidth())));
  }

  static double wanted_segment(double bandwidth) { return std::sqrt(4.0 / (3.0 * bias_wanted)) / bandwidth; }

  void segment(double bandwidth) {
    if (settings_.segment) {
      result_.segment = *settings_.segment;
      if (!(result_.segment <= available()))
        throw UsageError(fmt::format("no frequency response: a segment of {:g} s is longer than the {:.4g} s that are "
                                     "left after {:.4g} s of settling",
                                     result_.segment, available(), result_.settling));
      return;
    }
    result_.segment = available() / 4.5; // eight, half overlapping
    if (bandwidth > 0.0) result_.segment = std::min(result_.segment, wanted_segment(bandwidth));
    // A narrow band needs its lines, even if few segments are left to average.
    const double band = (std::isfinite(drive_.high) ? high_ : rows_per_period * rows_.end) - drive_.low;
    if (result_.segment * band < fewest_lines) result_.segment = std::min(fewest_lines / band, available());
  }

  /// As many segments as there are, or `count`, counted from the end of the record.
  void spectra(SpectralWindow window, double hop, double count) {
    const std::size_t length = transform_length(static_cast<std::size_t>(std::ceil(result_.segment / rows_.mean)));
    const double interval = result_.segment / static_cast<double>(length);
    Segmentation segmentation{length, length, window};
    if (hop < 1.0) segmentation.hop = length / 2;
    const auto samples = count > 0.0 ? static_cast<std::size_t>(count) * length
                                     : static_cast<std::size_t>(std::floor(available() / interval + 1e-6));
    const double start = std::max(0.0, rows_.end - static_cast<double>(samples) * interval);
    result_.spectra =
        estimate_spectra(even_record(history_, start, interval, samples), segmentation, drive_.low, high_);
    keep_driven_lines();
  }

  /// Beyond where the force has power, what is found is no response to it.
  void keep_driven_lines() {
    Spectra& spectra = result_.spectra;
    const double largest = spectra.force.empty() ? 0.0 : *std::max_element(spectra.force.begin(), spectra.force.end());
    if (!(largest > 0.0))
      throw UsageError(fmt::format("no frequency response: there is no force between {:g} and {:.4g} Hz in {:.4g} s "
                                   "of history (lines {:.3g} Hz apart)",
                                   drive_.low, high_, available(), spectra.resolution));
    const auto enough = [&](double power) { return power >= power_floor * largest; };
    const auto first = std::find_if(spectra.force.begin(), spectra.force.end(), enough) - spectra.force.begin();
    const auto last = std::isfinite(drive_.high)
                          ? spectra.force.rend() - std::find_if(spectra.force.rbegin(), spectra.force.rend(), enough)
                          : end_of_power(power_floor * largest);
    Spectra kept;
    for (auto k = static_cast<std::size_t>(first); k < static_cast<std::size_t>(last); ++k) {
      if (spectra.force[k] < power_nothing * largest) continue;
      kept.frequency.push_back(spectra.frequency[k]);
      kept.force.push_back(spectra.force[k]);
      kept.displacement.push_back(spectra.displacement[k]);
      kept.cross.push_back(spectra.cross[k]);
    }
    if (kept.frequency.size() < 3)
      throw UsageError(fmt::format("no frequency response: {} lines between {:g} and {:.4g} Hz; the run is too short, "
                                   "or its force holds too few frequencies (a harmonic one has one: use a sweep)",
                                   kept.frequency.size(), drive_.low, high_));
    std::swap(kept.frequency, spectra.frequency);
    std::swap(kept.force, spectra.force);
    std::swap(kept.displacement, spectra.displacement);
    std::swap(kept.cross, spectra.cross);
  }

  /// Where a force of no stated band first falls silent above its largest line, and not for a line or two by chance.
  std::ptrdiff_t end_of_power(double floor) const {
    const std::vector<double>& force = result_.spectra.force;
    const auto top = std::max_element(force.begin(), force.end());
    return std::search_n(top, force.end(), 5, floor, std::less<>()) - force.begin();
  }

  void finish() {
    result_.response.clear();
    result_.bare.clear();
    result_.added_mass.clear();
    for (std::size_t k = 0; k < result_.spectra.frequency.size(); ++k) {
      result_.response.push_back(result_.spectra.response(k));
      result_.bare.push_back(host_.bare(result_.spectra.frequency[k]));
      result_.added_mass.push_back(host_.added_mass(result_.spectra.frequency[k]));
    }
    const auto less = [](const auto& a, const auto& b) { return std::abs(a) < std::abs(b); };
    result_.peak = static_cast<std::size_t>(std::max_element(result_.response.begin(), result_.response.end(), less) -
                                            result_.response.begin());
    result_.fit = fit_resonance(result_.spectra.frequency, result_.response);
  }

  /// A record that is cut while the structure still swings is not its whole answer.
  void tell_of_what_is_left() {
    const std::size_t rows = history_.time.size(), tail = rows - rows / 20;
    double mean = 0.0, largest = 0.0, left = 0.0;
    for (const double x : history_.displacement) mean += x / static_cast<double>(rows);
    for (std::size_t k = 0; k < rows; ++k) {
      const double swing = std::abs(history_.displacement[k] - mean);
      largest = std::max(largest, swing);
      if (k >= tail) left = std::max(left, swing);
    }
    if (left > 0.02 * largest)
      result_.notes.push_back(fmt::format("{:.2g} % of the largest swing is left at the end of the run, which cuts the "
                                          "answer short; lengthen time.duration",
                                          100.0 * left / largest));
  }

  const ResponseHistory& history_;
  const ExcitedBand& drive_;
  const LinearHost& host_;
  const ResponseSettings& settings_;
  Rows rows_;
  double high_ = 0.0;
  FrequencyResponse result_;
};

template <class Value> double mean_around_peak(const FrequencyResponse& of, const Value& value) {
  if (!of.has_coherence()) return std::numeric_limits<double>::quiet_NaN();
  const double half = 0.5 * std::abs(of.response[of.peak]);
  std::size_t begin = of.peak, end = of.peak + 1;
  while (begin > 0 && std::abs(of.response[begin - 1]) >= half) --begin;
  while (end < of.response.size() && std::abs(of.response[end]) >= half) ++end;
  double sum = 0.0;
  for (std::size_t k = begin; k < end; ++k) sum += value(k);
  return sum / static_cast<double>(end - begin);
}

} // namespace

const char* name(ResponseMethod method) {
  switch (method) {
  case ResponseMethod::periodic:
    return "periods";
  case ResponseMethod::welch:
    return "welch";
  case ResponseMethod::transient:
    return "transient";
  }
  return "";
}

double FrequencyResponse::mean_coherence() const {
  return mean_around_peak(*this, [this](std::size_t k) { return spectra.coherence(k); });
}

double FrequencyResponse::mean_random_error() const {
  return mean_around_peak(*this, [this](std::size_t k) { return spectra.random_error(k); });
}

bool FrequencyResponse::even() const {
  for (std::size_t k = 1; k < spectra.frequency.size(); ++k)
    if (std::abs(spectra.frequency[k] - spectra.frequency[k - 1] - spectra.resolution) > 1e-6 * spectra.resolution)
      return false;
  return true;
}

FrequencyResponse estimate_response(const ResponseHistory& history, const ExcitedBand& drive, const LinearHost& host,
                                    const ResponseSettings& settings) {
  return Estimate(history, drive, host, settings).make();
}

} // namespace grandamp
