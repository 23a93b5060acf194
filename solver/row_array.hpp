// A plain array of rows: aligned to cache lines, not initialised, so that pages are first touched by whoever fills
// them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <sys/mman.h>
#include <type_traits>
#include <utility>

namespace grandamp {

/// Memory on a cache line's boundary, to be given to std::free. From half a large page on it is a number of large
/// pages, if the system has them to give: of small ones an array has more than a processor remembers the places of.
/// Throws std::bad_alloc.
inline void* allocate_rows(std::size_t bytes) {
  constexpr std::size_t line = 64, large_page = std::size_t{1} << 21;
  const bool on_large_pages = 2 * bytes >= large_page;
  const std::size_t unit = on_large_pages ? large_page : line, whole = (bytes + unit - 1) / unit * unit;
  void* const rows = std::aligned_alloc(unit, whole);
  if (rows == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
  if (on_large_pages) madvise(rows, whole, MADV_HUGEPAGE); // a wish: what it answers changes nothing
#endif
  return rows;
}

template <class T> class RowArray {
  static_assert(std::is_trivially_copyable_v<T>);

public:
  RowArray() = default;
  explicit RowArray(std::size_t size) { reset(size); }
  RowArray(RowArray&& other) noexcept { swap(other); }
  RowArray& operator=(RowArray&& other) noexcept {
    swap(other);
    return *this;
  }
  RowArray(const RowArray&) = delete;
  RowArray& operator=(const RowArray&) = delete;
  ~RowArray() { std::free(data_); }

  /// Drops what is there; the new elements are not initialised.
  void reset(std::size_t size) {
    std::free(data_);
    data_ = nullptr;
    size_ = 0;
    if (size == 0) return;
    data_ = static_cast<T*>(allocate_rows(size * sizeof(T)));
    size_ = size;
  }

  /// Keeps the first `keep` elements.
  void grow(std::size_t size, std::size_t keep) {
    RowArray larger(size);
    for (std::size_t k = 0; k < keep; ++k) larger.data_[k] = data_[k];
    swap(larger);
  }

  RowArray copy() const {
    RowArray other(size_);
    std::copy_n(data_, size_, other.data_);
    return other;
  }

  T* data() noexcept { return data_; }
  const T* data() const noexcept { return data_; }
  std::size_t size() const noexcept { return size_; }
  T& operator[](std::size_t k) noexcept { return data_[k]; }
  const T& operator[](std::size_t k) const noexcept { return data_[k]; }
  void swap(RowArray& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
  }
  /// Exchanges memory with an array of another type of row, of the same size: one buffer then serves the other's turn.
  template <class Other> void swap_memory(RowArray<Other>& other) noexcept {
    static_assert(sizeof(Other) == sizeof(T) && alignof(Other) == alignof(T));
    T* const mine = data_;
    data_ = reinterpret_cast<T*>(other.data_);
    other.data_ = reinterpret_cast<Other*>(mine);
    std::swap(size_, other.size_);
  }

private:
  template <class Other> friend class RowArray;

  T* data_ = nullptr;
  std::size_t size_ = 0;
};

} // namespace grandamp
