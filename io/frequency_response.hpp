// The frequency response of a structure, displacement over force, from the history of one run.
#pragma once

#include "io/even_record.hpp"
#include "io/resonance_fit.hpp"
#include "io/spectra.hpp"

#include <complex>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace grandamp {

/// How the record is cut, by what the force is like.
enum class ResponseMethod {
  periodic,  ///< whole periods of a force that repeats itself, no window: nothing leaks
  welch,     ///< half overlapping segments under a Hann window
  transient, ///< one transform of the whole, from rest on: no coherence
};

const char* name(ResponseMethod method);

/// What is known of the force beforehand.
struct ExcitedBand {
  ResponseMethod method = ResponseMethod::welch;
  double low = 0.0;    ///< where it holds power, Hz
  double high = 0.0;   ///< Hz; infinite: as far as its spectrum shows power
  double period = 0.0; ///< of a periodic one, s
};

/// The structure without granules, and with them as added mass, in closed form; m/N at a frequency in Hz.
struct LinearHost {
  std::function<std::complex<double>(double)> bare, added_mass;
  double decay_rate = 0.0; ///< with the added mass: free vibration dies as exp(-decay_rate t), 1/s; 0: it does not
  double bandwidth = 0.0;  ///< of the resonance at half power, bare, Hz
};

struct ResponseSettings {
  std::optional<double> settling{}; ///< s that are left out at the start
  std::optional<double> segment{};  ///< s, of Welch's
};

struct FrequencyResponse {
  ResponseMethod method = ResponseMethod::welch;
  double settling = 0.0; ///< left out at the start, s
  double segment = 0.0;  ///< s
  Spectra spectra;
  std::vector<std::complex<double>> response;         ///< H1 by line, m/N
  LinearHost host;                                    ///< as it was given
  std::vector<std::complex<double>> bare, added_mass; ///< its closed forms by line, m/N
  std::size_t peak = 0;                               ///< line of the largest |H1|
  ResonanceFit fit;
  double bias = 0.0;              ///< of the peak's magnitude by the window, over it, estimated; 0 without a window
  std::vector<std::string> notes; ///< what is worth knowing of it

  bool has_coherence() const { return spectra.segments > 1; }
  /// Means over the lines that the fit took as the top: at least half of the largest; NaN without coherence.
  double mean_coherence() const;
  double mean_random_error() const;
  /// Lines at even distances.
  bool even() const;
};

/// Left out, settling is until a thousandth of the structure's free vibration is left (nothing for a transient), and
/// Welch's segments are long enough for a bias of 0.5 % at the peak, if eight of them go into the record.
/// Throws UsageError where there is no response to be had, with the reason and what to change.
FrequencyResponse estimate_response(const ResponseHistory& history, const ExcitedBand& drive, const LinearHost& host,
                                    const ResponseSettings& settings = {});

} // namespace grandamp
