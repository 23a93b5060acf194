// A list that its copies share until one of them is changed. A scene goes by value from its file to the plan and the
// run, and granules listed in it may be much of what a run holds.
#pragma once

#include <atomic>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace grandamp {

/// A std::vector by its names. What a list that is not const hands out may be written through, so from then on its
/// copies are copies at once, until it is assigned to: fill a vector, and move it here.
template <class T> class SharedList {
public:
  SharedList() = default;
  SharedList(std::vector<T> values) : values_(std::make_shared<std::vector<T>>(std::move(values))) {}
  SharedList(std::initializer_list<T> values) : SharedList(std::vector<T>(values)) {}
  SharedList(const SharedList& from)
      : values_(from.lent_ && from.values_ ? std::make_shared<std::vector<T>>(*from.values_) : from.values_) {}
  SharedList(SharedList&& from) noexcept : values_(std::move(from.values_)), lent_(std::exchange(from.lent_, false)) {}
  SharedList& operator=(SharedList from) noexcept {
    std::swap(values_, from.values_);
    std::swap(lent_, from.lent_);
    return *this;
  }
  ~SharedList() = default;

  operator const std::vector<T>&() const& noexcept { return all(); }
  operator const std::vector<T>&() const&& = delete; // of a temporary: it would outlive its list
  std::size_t size() const noexcept { return values_ ? values_->size() : 0; }
  bool empty() const noexcept { return size() == 0; }
  const T& operator[](std::size_t i) const { return (*values_)[i]; }
  const T& at(std::size_t i) const { return all().at(i); }
  const T& front() const { return values_->front(); }
  const T& back() const { return values_->back(); }
  const T* data() const noexcept { return values_ ? values_->data() : nullptr; }
  const T* begin() const noexcept { return data(); }
  const T* end() const noexcept { return data() + size(); }
  const T* cbegin() const noexcept { return begin(); }
  const T* cend() const noexcept { return end(); }

  T& operator[](std::size_t i) { return lend()[i]; }
  T& front() { return lend().front(); }
  T& back() { return lend().back(); }
  T* data() { return lend().data(); }
  T* begin() { return data(); }
  T* end() { return data() + size(); }
  T* erase(const T* at) { return erase(at, at + 1); }
  T* erase(const T* first, const T* last) {
    const auto from = first - std::as_const(*this).begin(), to = last - std::as_const(*this).begin();
    std::vector<T>& values = lend();
    values.erase(values.begin() + from, values.begin() + to);
    return values.data() + from;
  }
  void clear() noexcept { *this = SharedList(); }
  void reserve(std::size_t size) { own().reserve(size); }
  void push_back(const T& value) { own().push_back(value); }
  void pop_back() { own().pop_back(); }
  void resize(std::size_t size, const T& value = T{}) { own().resize(size, value); }
  void assign(std::size_t size, const T& value) { *this = std::vector<T>(size, value); }

  friend bool operator==(const SharedList& a, const SharedList& b) { return a.all() == b.all(); }
  friend bool operator==(const SharedList& a, const std::vector<T>& b) { return a.all() == b; }

private:
  const std::vector<T>& all() const noexcept {
    static const std::vector<T> none;
    return values_ ? *values_ : none;
  }
  std::vector<T>& own() {
    if (!values_)
      values_ = std::make_shared<std::vector<T>>();
    else if (values_.use_count() > 1)
      values_ = std::make_shared<std::vector<T>>(*values_);
    else
      std::atomic_thread_fence(std::memory_order_acquire); // another thread's copy may just have been made and let go
    return *values_;
  }
  std::vector<T>& lend() {
    std::vector<T>& values = own();
    lent_ = true;
    return values;
  }

  std::shared_ptr<std::vector<T>> values_;
  bool lent_ = false;
};

} // namespace grandamp
