// A list that its copies share until one of them is changed. A scene goes by value from its file to the plan and the
// run, and granules listed in it may be much of what a run holds.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace grandamp {

/// A std::vector by its names. Two threads may change two copies at a time, but not one of them.
template <class T> class SharedList {
public:
  using value_type = T;
  using iterator = typename std::vector<T>::iterator;
  using const_iterator = typename std::vector<T>::const_iterator;

  SharedList() = default;
  SharedList(std::vector<T> values) : values_(std::make_shared<std::vector<T>>(std::move(values))) {}
  SharedList(std::initializer_list<T> values) : SharedList(std::vector<T>(values)) {}

  operator const std::vector<T>&() const noexcept { return all(); }
  std::size_t size() const noexcept { return all().size(); }
  bool empty() const noexcept { return all().empty(); }
  const T& operator[](std::size_t i) const { return all()[i]; }
  const T& front() const { return all().front(); }
  const T& back() const { return all().back(); }
  const_iterator begin() const noexcept { return all().begin(); }
  const_iterator end() const noexcept { return all().end(); }

  T& operator[](std::size_t i) { return own()[i]; }
  T& front() { return own().front(); }
  T& back() { return own().back(); }
  iterator begin() { return own().begin(); }
  iterator end() { return own().end(); }
  void clear() noexcept { values_.reset(); }
  void push_back(const T& value) { own().push_back(value); }
  void resize(std::size_t size, const T& value = T{}) { own().resize(size, value); }
  iterator erase(iterator at) { return own().erase(at); }
  iterator erase(iterator first, iterator last) { return own().erase(first, last); }
  void assign(std::size_t size, const T& value) { *this = std::vector<T>(size, value); }

  friend bool operator==(const SharedList& a, const SharedList& b) { return a.all() == b.all(); }

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
    return *values_;
  }

  std::shared_ptr<std::vector<T>> values_;
};

} // namespace grandamp
