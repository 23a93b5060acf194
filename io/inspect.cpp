#include "io/inspect.hpp"

#include "io/hdf5.hpp"
#include "io/hdf5_seal.hpp"
#include "solver/errors.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <functional>
#include <optional>

namespace grandamp {
namespace {

constexpr unsigned patience = 60; // s, for HDF5 to read the contents
constexpr std::size_t most_alike = 3;

struct ChildOutcome {
  std::string text;
  std::string failure; ///< empty: it went well
};

void write_all(int pipe, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t part = ::write(pipe, text.data() + done, text.size() - done);
    if (part < 0 && errno == EINTR) continue;
    if (part <= 0) return;
    done += static_cast<std::size_t>(part);
  }
}

std::string read_all(int pipe) {
  std::string text(4096, '\0');
  std::string all;
  while (true) {
    const ssize_t part = ::read(pipe, text.data(), text.size());
    if (part < 0 && errno == EINTR) continue;
    if (part <= 0) return all;
    all.append(text, 0, static_cast<std::size_t>(part));
  }
}

/// What `tell` returns, from a process of its own.
ChildOutcome in_child(const std::function<std::string()>& tell) {
  int ends[2];
  if (::pipe(ends) != 0) throw FileError(std::string("cannot start a process: ") + std::strerror(errno));
  const pid_t child = ::fork();
  if (child < 0) throw FileError(std::string("cannot start a process: ") + std::strerror(errno));
  if (child == 0) {
    for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGALRM}) std::signal(signal, SIG_DFL);
    ::close(ends[0]);
    ::alarm(patience);
    int status = 0;
    try {
      write_all(ends[1], tell());
    } catch (const std::exception& error) {
      write_all(ends[1], error.what());
      status = 1;
    }
    ::_exit(status); // nothing of the parent's is to be closed or flushed twice
  }
  ::close(ends[1]);
  ChildOutcome outcome{read_all(ends[0]), ""};
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) {
    outcome.failure = WTERMSIG(status) == SIGALRM ? fmt::format("HDF5 did not come to an end in {} s", patience)
                                                  : std::string("HDF5 crashed on it: ") + strsignal(WTERMSIG(status));
  } else if (WEXITSTATUS(status) != 0) {
    outcome.failure = outcome.text;
    outcome.text.clear();
  }
  return outcome;
}

std::string shape_text(const hdf5::Dataset& dataset) {
  return dataset.shape.empty() ? "" : fmt::format("[{}]", fmt::join(dataset.shape, " x "));
}

class Listing {
public:
  explicit Listing(const hdf5::File& file) : file_(file) {}

  std::string text() {
    add_group("/");
    return std::move(text_);
  }

private:
  void add_group(const std::string& group) {
    // Of many groups that are alike, as snapshots are, the first few tell all.
    std::size_t groups = 0, left_out = 0;
    std::string last;
    const std::string prefix = group == "/" ? group : group + "/";
    for (const std::string& member : file_.members(group)) {
      const std::string name = prefix + member;
      const std::optional<hdf5::Dataset> dataset = file_.dataset(name);
      if (dataset) {
        add(name, *dataset);
      } else if (group == "/" || ++groups <= most_alike) {
        text_ += fmt::format("  {}{}\n", name, attributes_text(name));
        add_group(name);
      } else {
        ++left_out;
        last = name;
      }
    }
    if (left_out > 0) text_ += fmt::format("  ... and {} more groups to {}{}\n", left_out, last, attributes_text(last));
  }

  void add(const std::string& name, const hdf5::Dataset& dataset) {
    text_ += fmt::format("  {:<32} {:<8} {:<16} {:<6} {}\n", name, dataset.type, shape_text(dataset), dataset.units,
                         dataset.description);
    while (text_.size() > 1 && text_[text_.size() - 2] == ' ') text_.erase(text_.size() - 2, 1);
  }

  std::string attributes_text(const std::string& group) const {
    std::string text;
    for (const auto& [name, value] : file_.attributes(group))
      text += fmt::format("{} {} = {}", text.empty() ? " :" : ",", name, value);
    return text;
  }

  const hdf5::File& file_;
  std::string text_;
};

std::string time_text(const hdf5::File& file) {
  const std::optional<hdf5::Dataset> time = file.dataset("/history/time");
  if (time) {
    const std::vector<double> rows = file.read_doubles("/history/time");
    const bool ended = file.has("/final");
    return fmt::format("time reached: {} s, {} rows of history{}\n", rows.empty() ? 0.0 : rows.back(), rows.size(),
                       ended ? "; the granules at the end are there" : "; the run is not at its end");
  }
  for (const auto& [name, value] : file.attributes("/"))
    if (name == "time") return fmt::format("time reached: {} s\n", value);
  return "";
}

std::string contents(const std::filesystem::path& path) {
  const hdf5::File file = hdf5::File::open_at_risk(path);
  std::string text;
  for (const auto& [name, value] : file.attributes("/")) text += fmt::format("{}: {}\n", name, value);
  text += time_text(file);
  return text + Listing(file).text();
}

} // namespace

Inspection inspect(const std::filesystem::path& path) {
  using State = hdf5::SealReport::State;
  const hdf5::SealReport seal = hdf5::check_seal(path);
  const ChildOutcome outcome = in_child([&path] { return contents(path); });
  Inspection inspection;
  inspection.whole = seal.state == State::whole && outcome.failure.empty();
  switch (seal.state) {
  case State::whole:
    inspection.text = path.string() + ": whole\n";
    break;
  case State::damaged:
    inspection.text = fmt::format("{}: damaged: {}\n", path.string(), seal.what);
    break;
  case State::unsealed:
    inspection.text = fmt::format("{}: {}, so that nothing tells whether it is whole\n", path.string(), seal.what);
    break;
  }
  if (!outcome.failure.empty())
    inspection.text += fmt::format("HDF5 cannot read it: {}\n", outcome.failure);
  else if (seal.state == State::damaged)
    inspection.text += "HDF5 can still read this, but the numbers may be wrong:\n";
  inspection.text += outcome.text;
  return inspection;
}

} // namespace grandamp
