// What the processor itself needs: square roots and divisions (the contact law's floor), and a candidate test whose
// coordinates are gathered from plain component arrays, the design that rows were chosen over.
#include <benchmark/benchmark.h>

#include <immintrin.h>

#include <cstdint>
#include <random>
#include <vector>

namespace {

constexpr std::size_t count = 1024; // doubles: in the first-level cache

std::vector<double> numbers() {
  std::vector<double> v(count);
  for (std::size_t k = 0; k < count; ++k) v[k] = 1.0 + 1.0e-3 * static_cast<double>(k);
  return v;
}

void report(benchmark::State& state, double items) {
  state.counters["ns_per_item"] =
      benchmark::Counter(1e-9 * items, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

__attribute__((target("avx2,fma"))) void roots_avx2(const double* from, double* to) {
  for (std::size_t k = 0; k < count; k += 4) _mm256_storeu_pd(to + k, _mm256_sqrt_pd(_mm256_loadu_pd(from + k)));
}
__attribute__((target("avx2,fma"))) void divisions_avx2(const double* from, double* to) {
  for (std::size_t k = 0; k < count; k += 4)
    _mm256_storeu_pd(to + k, _mm256_div_pd(_mm256_set1_pd(1.5), _mm256_loadu_pd(from + k)));
}
__attribute__((target("avx512f"))) void roots_avx512(const double* from, double* to) {
  for (std::size_t k = 0; k < count; k += 8) _mm512_storeu_pd(to + k, _mm512_sqrt_pd(_mm512_loadu_pd(from + k)));
}
__attribute__((target("avx512f"))) void divisions_avx512(const double* from, double* to) {
  for (std::size_t k = 0; k < count; k += 8)
    _mm512_storeu_pd(to + k, _mm512_div_pd(_mm512_set1_pd(1.5), _mm512_loadu_pd(from + k)));
}

void arithmetic(benchmark::State& state, void (*work)(const double*, double*)) {
  const std::vector<double> from = numbers();
  std::vector<double> to(count);
  for (auto _ : state) {
    work(from.data(), to.data());
    benchmark::ClobberMemory();
  }
  report(state, count);
}

/// Component arrays, and pairs as two index arrays: each of the eight coordinates of a pair costs a gather.
struct Components {
  std::vector<double> x, y, z, radius;
  std::vector<std::int32_t> first, second;

  Components() {
    constexpr int granules = 2048;
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<double> any(0.0, 30.0);
    for (int i = 0; i < granules; ++i) {
      x.push_back(any(engine));
      y.push_back(any(engine));
      z.push_back(any(engine));
      radius.push_back(1.0e-3);
      for (int k = 1; k <= 4; ++k) { // four partners, as near in memory as a sorted bed's
        first.push_back(i);
        second.push_back((i + k * 17) % granules);
      }
    }
  }
};

__attribute__((target("avx2,fma"))) std::size_t gathered_test(const Components& c, std::uint32_t* touching) {
  std::size_t n = 0;
  for (std::size_t k = 0; k < c.first.size(); k += 4) {
    const __m128i i = _mm_loadu_si128(reinterpret_cast<const __m128i*>(c.first.data() + k));
    const __m128i j = _mm_loadu_si128(reinterpret_cast<const __m128i*>(c.second.data() + k));
    const __m256d dx = _mm256_sub_pd(_mm256_i32gather_pd(c.x.data(), j, 8), _mm256_i32gather_pd(c.x.data(), i, 8));
    const __m256d dy = _mm256_sub_pd(_mm256_i32gather_pd(c.y.data(), j, 8), _mm256_i32gather_pd(c.y.data(), i, 8));
    const __m256d dz = _mm256_sub_pd(_mm256_i32gather_pd(c.z.data(), j, 8), _mm256_i32gather_pd(c.z.data(), i, 8));
    const __m256d radii =
        _mm256_add_pd(_mm256_i32gather_pd(c.radius.data(), j, 8), _mm256_i32gather_pd(c.radius.data(), i, 8));
    const __m256d square = _mm256_fmadd_pd(dz, dz, _mm256_fmadd_pd(dy, dy, _mm256_mul_pd(dx, dx)));
    const int mask = _mm256_movemask_pd(_mm256_cmp_pd(square, _mm256_mul_pd(radii, radii), _CMP_LT_OQ));
    for (int left = mask; left != 0; left &= left - 1)
      touching[n++] =
          static_cast<std::uint32_t>(k) + static_cast<std::uint32_t>(__builtin_ctz(static_cast<unsigned>(left)));
  }
  return n;
}

void gathers(benchmark::State& state) {
  const Components components;
  std::vector<std::uint32_t> touching(components.first.size());
  for (auto _ : state) {
    benchmark::DoNotOptimize(gathered_test(components, touching.data()));
    benchmark::ClobberMemory();
  }
  report(state, static_cast<double>(components.first.size()));
}

} // namespace

void register_limits();
void register_limits() {
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    benchmark::RegisterBenchmark("avx2/limit/square_root", arithmetic, roots_avx2);
    benchmark::RegisterBenchmark("avx2/limit/division", arithmetic, divisions_avx2);
    benchmark::RegisterBenchmark("avx2/limit/candidate_by_gathers", gathers);
  }
  if (__builtin_cpu_supports("avx512f")) {
    benchmark::RegisterBenchmark("avx512/limit/square_root", arithmetic, roots_avx512);
    benchmark::RegisterBenchmark("avx512/limit/division", arithmetic, divisions_avx512);
  }
}
