#include "io/case_pool.hpp"

#include "io/case_process.hpp"
#include "io/recorder.hpp"
#include "io/run.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <optional>
#include <system_error>
#include <thread>

namespace grandamp {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds glance{5};

/// The processes at work, and the jobs that wait.
class Pool {
public:
  Pool(std::vector<CaseJob> jobs, const CasePoolOptions& options)
      : jobs_(std::move(jobs)), options_(options), begun_(WallClock::now()) {
    std::stable_sort(jobs_.begin(), jobs_.end(), [](const CaseJob& a, const CaseJob& b) { return a.work > b.work; });
    for (const CaseJob& job : jobs_) all_work_ += job.work;
  }

  bool run() {
    tell();
    while (next_ < jobs_.size() || !running_.empty()) {
      const bool stop = options_.stop_requested && options_.stop_requested();
      if (stop && !stopping_) {
        stopping_ = true;
        for (Running& one : running_) one.process.ask_to_stop();
      }
      while (!stopping_ && running_.size() < options_.at_a_time && next_ < jobs_.size()) start(jobs_[next_++]);
      if (stopping_ && running_.empty()) return false;
      bool any = false;
      for (std::size_t k = 0; k < running_.size();) {
        const std::optional<int> status = running_[k].process.ended();
        if (status) {
          const CaseJob* job = running_[k].job;
          running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(k));
          finish(*job, *status);
          any = true;
        } else {
          ++k;
        }
      }
      tell();
      if (!any) std::this_thread::sleep_for(glance);
    }
    return !stopping_;
  }

private:
  struct Running {
    const CaseJob* job;
    CaseProcess process;
    WallClock::time_point begun;
  };

  void start(const CaseJob& job) {
    std::error_code error;
    fs::create_directories(job.folder, error);
    if (error) throw FileError(job.folder.string() + ": cannot make the folder: " + error.message());
    fs::remove(job.folder / "failure.json", error);
    std::vector<std::string> arguments;
    if (fs::exists(job.folder / "scene.toml", error)) {
      arguments = {"resume", job.folder.string()};
    } else {
      arguments = {"run", job.scene.string(), "-o", job.folder.string(), "--force"};
      for (const std::string& one : job.overrides) arguments.insert(arguments.end(), {"--set", one});
    }
    arguments.insert(arguments.end(), {"--quiet", "--threads", std::to_string(options_.threads_each)});
    if (!options_.isa.empty()) arguments.insert(arguments.end(), {"--isa", options_.isa});
    running_.push_back({&job, CaseProcess(arguments, job.folder / "log.txt"), WallClock::now()});
  }

  void finish(const CaseJob& job, int status) {
    const CaseState state = state_of(job);
    const bool elsewhere = state.status == CaseStatus::running_elsewhere || state.status == CaseStatus::done;
    // A process that is asked to stop before it listens dies of that.
    const bool stopped = status == 130 || status == 128 + SIGTERM || status == 128 + SIGINT || status == 128 + SIGHUP;
    if (status != 0 && !stopped && !elsewhere) {
      const std::string error = told_error(job.folder / "log.txt", status);
      note_failure(job, status, error);
      if (options_.warning) options_.warning(fmt::format("{}: failed: {}", job.folder.string(), error));
    }
    // A case that was told to stop, by whomever, is not done; it goes on when the command is given again.
    if (stopped && !stopping_ && options_.warning)
      options_.warning(job.folder.string() + ": was interrupted; the same command goes on with it");
    ++done_;
    done_work_ += job.work;
  }

  void tell() {
    if (!options_.progress) return;
    CaseProgress progress;
    progress.done = done_;
    progress.running = running_.size();
    progress.all = jobs_.size();
    progress.seconds = seconds_since(begun_);
    if (done_work_ > 0.0 && progress.seconds > 0.0) {
      // What one process does in a second, as those that are done tell; those at work are taken to be on their way.
      double busy = busy_seconds_of_done();
      double under_way = 0.0;
      const double rate = done_work_ / busy;
      for (const Running& one : running_) under_way += std::min(0.95 * one.job->work, seconds_since(one.begun) * rate);
      const auto side_by_side = static_cast<double>(std::min(options_.at_a_time, jobs_.size()));
      progress.left = std::max(all_work_ - done_work_ - under_way, 0.0) / (rate * side_by_side);
    }
    options_.progress(progress);
  }

  double busy_seconds_of_done() const {
    double busy = seconds_since(begun_) * static_cast<double>(std::min(options_.at_a_time, jobs_.size()));
    for (const Running& one : running_) busy -= seconds_since(one.begun);
    return std::max(busy, 1e-3);
  }

  std::vector<CaseJob> jobs_;
  const CasePoolOptions& options_;
  WallClock::time_point begun_;
  std::vector<Running> running_;
  std::size_t next_ = 0, done_ = 0;
  double all_work_ = 0.0, done_work_ = 0.0;
  bool stopping_ = false;
};

} // namespace

bool run_case_jobs(std::vector<CaseJob> jobs, const CasePoolOptions& options) {
  std::erase_if(jobs, [](const CaseJob& job) {
    const CaseState state = state_of(job);
    return state.status == CaseStatus::done || state.status == CaseStatus::running_elsewhere ||
           (state.status == CaseStatus::failed && state.exit_status == 3);
  });
  return Pool(std::move(jobs), options).run();
}

} // namespace grandamp
