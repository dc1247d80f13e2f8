#include "runners/run/study_runner.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <mutex>

#include "runners/march/prepare_case.hpp"
#include "runners/march/seconds.hpp"
#include "runners/report/html.hpp"
#include "runners/run/finish_run.hpp"
#include "runners/run/say.hpp"
#include "runners/run/study_cases.hpp"
#include "runners/run/waiting_line.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/store/store.hpp"
#include "runners/study/study_files.hpp"
#include "runners/table/text.hpp"
#include "runners/workers/allowed_processors.hpp"

namespace ricochet {
namespace {

constexpr int kStoreUnusable = 5;

/// What a long case has so far goes to the store, and to the report: it can be looked at while the run goes on.
void show_partial(const StudyRunner& runner, Store& store, const std::filesystem::path& folder,
                  const CaseRecord& record) {
  // Cases on several threads share the folder: one page at a time, and none waits for another's.
  static std::mutex page;
  store.save_partial(record);
  const std::unique_lock lock(page, std::try_to_lock);
  if (lock) write_file(folder / "report.html", runner.render(with_tables(store.load())));
}

/// One run of a study in its folder, from the store's opening to the report.
class FolderRun {
 public:
  FolderRun(const StudyRunner& runner, const Study& study, const RunOptions& options, std::filesystem::path folder)
      : runner_(runner),
        study_(study),
        folder_(std::move(folder)),
        stop_(signals_.requested()),
        store_(folder_, options.fresh),
        part_(options.part),
        table_(options.table),
        jobs_(options.jobs > 0 ? options.jobs : allowed_processors().count) {}

  int run() {
    if (const auto held = store_.part(); held && *held != part_)
      throw PartRefused(other_part_text(folder_, study_.name, *held, part_));
    {
      const WaitingLine waiting("reading what the cases depend on", runner_.messages);
      for (const ExpectedCase& one : expected_cases(runner_.libraries, study_)) fingerprints_[one.id] = one.fingerprint;
    }
    if (!deal()) return interrupted();
    begin();
    say(runner_.messages, versions_text(store_));
    take_over();
    announce();
    if (runner_.cases.open) runner_.cases.open(checkpoint_store(), stop_);
    if (stop_) return interrupted();
    if (!run_missing()) return interrupted();
    if (runner_.cases.time && !time()) return interrupted();
    store_.nothing_under_way();
    return finish();
  }

 private:
  void tell(const std::string& line) { say(runner_.messages, line + "\n"); }

  /// Finds the cases of this run: all, or those of its part, for which all are planned. False: interrupted.
  bool deal() {
    for (const StudyCase& one : study_.cases) cases_.push_back(&one);
    if (part_.whole()) return true;
    tell(fmt::format("{}: planning {} cases, to deal them into {} parts", study_.name, cases_.size(), part_.of));
    std::vector<CaseRecord> excluded;
    std::vector<PendingCase> all;
    find_missing(cases_, fingerprints_, {}, excluded, all);
    predict_cases(runner_, all, jobs_, stop_);
    for (const PendingCase& one : all) predicted_[one.study_case->id] = one.predicted_seconds;
    cases_ = cases_of_part(study_, part_, predicted_);
    return !stop_;
  }

  /// What the store holds of these cases is kept.
  void begin() {
    const WaitingLine waiting("looking what " + folder_.string() + " holds", runner_.messages);
    StudyResults header = results_header(study_);
    header.expected_cases = static_cast<int>(cases_.size());
    header.part = part_;
    kept_ = store_.begin(header, expected(), runner_.arithmetic);
  }

  std::vector<ExpectedCase> expected() const {
    std::vector<ExpectedCase> cases;
    for (const StudyCase* one : cases_) cases.push_back({one->id, fingerprints_.at(one->id)});
    return cases;
  }

  void note_failure(const CaseRecord& record) {
    const std::lock_guard guard(failed_mutex_);
    if (record.status == Status::failed) failed_.insert(record.id);
  }

  /// What the last run left: a case that was under way when it was killed runs again.
  void take_over() {
    failed_ = store_.failed();
    std::vector<std::string> left = store_.left_under_way();
    std::erase_if(left, [&](const std::string& id) {
      return kept_.count(id) != 0 ||
             std::none_of(cases_.begin(), cases_.end(), [&](const StudyCase* one) { return one->id == id; });
    });
    constexpr std::size_t named = 8;
    if (const std::vector<std::string>& damaged = store_.damaged(); !damaged.empty())
      tell(fmt::format("{}: {} {} damaged: computed again", (folder_ / "results.sqlite").string(),
                       plain_text(report::list_text(damaged, named)), damaged.size() == 1 ? "is" : "are"));
    if (!left.empty())
      tell(fmt::format("an earlier run ended while {} {} under way: run again", report::list_text(left, named),
                       left.size() == 1 ? "was" : "were"));
    store_.nothing_under_way();
  }

  /// Before any code of a plugin runs: from now on the cost of these cases is predicted, and what they share computed.
  void announce() {
    std::vector<std::string> ids;
    for (const StudyCase* one : cases_)
      if (!one->excluded && kept_.count(one->id) == 0) ids.push_back(one->id);
    if (!ids.empty()) store_.begins(ids, Store::Stage::plan);
  }

  CheckpointStore checkpoint_store() {
    CheckpointStore checkpoints;
    checkpoints.find = [this](const std::string& key) { return store_.motion(key); };
    checkpoints.keep = [this](const std::string& key, const std::string& content) { store_.save_motion(key, content); };
    checkpoints.show = [this](const CaseRecord& record) { show_partial(runner_, store_, folder_, record); };
    checkpoints.failed = [this](const std::string& id) {
      const std::lock_guard guard(failed_mutex_);
      return failed_.count(id) != 0;
    };
    checkpoints.waiting = [this](const std::string& id, const std::string& call) { say_waiting(id, call); };
    return checkpoints;
  }

  void say_waiting(const std::string& id, const std::string& call) {
    constexpr double every = 10;
    const std::lock_guard guard(waiting_mutex_);
    if (progress_) return progress_->waiting(id, call);
    if (call.empty() || seconds_since(said_waiting_) < every) return;
    said_waiting_ = std::chrono::steady_clock::now();
    tell(fmt::format("waiting{}: {}", id.empty() ? "" : " for case " + id, call));
  }

  /// False: interrupted.
  bool run_missing() {
    std::vector<CaseRecord> excluded;
    std::vector<PendingCase> pending;
    fresh_.merge(find_missing(cases_, fingerprints_, kept_, excluded, pending));
    if (!fresh_.empty()) {
      const Environment now = runner_.environment();
      store_.save_environment(kept_.empty() ? now : merge_environments(now, store_.environment()));
    }
    if (!excluded.empty()) store_.save(excluded);
    const std::size_t running = pending.size();
    tell(fmt::format("{}{}: {} case{}, {} finished before, {} to {}", study_.name,
                     part_.whole() ? "" : ", " + part_.text(), cases_.size(), cases_.size() == 1 ? "" : "s",
                     kept_.size(), running, running > 0 ? "plan and run " + workers() : "run"));
    if (running == 0) return true;
    store_.save_progress("planning, " + workers());
    if (part_.whole())
      predict_cases(runner_, pending, jobs_, stop_);
    else
      for (PendingCase& one : pending) one.predicted_seconds = predicted_[one.study_case->id];
    if (stop_) return false;
    return pending.empty() || run_pending(std::move(pending));
  }

  std::string workers() const { return runner_.workers.empty() ? "in this process" : "on " + runner_.workers; }

  /// While it lives, the progress line names the calls that cases wait for.
  class WaitingTold {
   public:
    WaitingTold(FolderRun& run, Progress& progress) : run_(run) { show(&progress); }
    ~WaitingTold() { show(nullptr); }
    WaitingTold(const WaitingTold&) = delete;
    WaitingTold& operator=(const WaitingTold&) = delete;

   private:
    void show(Progress* progress) {
      const std::lock_guard guard(run_.waiting_mutex_);
      run_.progress_ = progress;
    }
    FolderRun& run_;
  };

  bool run_pending(std::vector<PendingCase> pending) {
    const int running = static_cast<int>(pending.size());
    double work = 0;
    for (const PendingCase& one : pending) work += one.predicted_seconds;
    Progress progress(runner_.messages, is_terminal(runner_.messages), running, work, stop_,
                      [this](const std::string& text) {
                        try {
                          store_.save_progress(text + ", " + workers());
                        } catch (const StoreError&) {
                          // The next result that cannot be kept says so.
                        }
                      });
    CaseEvents events;
    events.begins = [&](std::span<const PendingCase> cases) {
      std::vector<std::string> ids;
      for (const PendingCase& one : cases) ids.push_back(one.study_case->id);
      store_.begins(ids, Store::Stage::run);
      progress.started(ids.front(), cases.front().predicted_seconds);
    };
    events.finished = [&](const CaseRecord& record, const PendingCase* next) {
      if (record.status == Status::failed && record.reason().find(changed_since) != std::string::npos)
        throw StoreError(
            fmt::format("{}. This case is not kept, those that finished are. Put the file back, or keep it, "
                        "and run again",
                        record.reason()));
      note_failure(record);
      store_.save({&record, 1});
      progress.finished(record.id);
      if (next) progress.started(next->study_case->id, next->predicted_seconds);
    };
    const WaitingTold told(*this, progress);
    return run_cases(runner_, std::move(pending), jobs_, stop_, events) == running;
  }

  bool time() {
    store_.save_progress("timing, one case at a time");
    const std::vector<CaseRecord> timed =
        time_cases(runner_, study_, store_.load(), study_.resolved.value("repeats", 1), stop_);
    if (stop_) return false;
    store_.save(timed);
    for (const CaseRecord& record : timed) fresh_.insert(record.id);
    return true;
  }

  int interrupted() {
    store_.nothing_under_way();
    say(runner_.messages, interrupted_text(folder_, store_.load()));
    return kInterrupted;
  }

  int finish() {
    const auto results = write_folder(store_, folder_, runner_.render, &fresh_, runner_.messages);
    const double seconds = seconds_since(begin_);
    // As `plan` counts them: what is refused does not run. Nor does what is kept, though its times are taken.
    const auto ran = std::count_if(results->cases.begin(), results->cases.end(), [this](const CaseRecord& one) {
      return fresh_.count(one.id) != 0 && kept_.count(one.id) == 0 && one.status != Status::refused;
    });
    return tell_results(runner_.out, *results, folder_,
                        fmt::format("{} run now in {}, {} kept", ran, duration_text(seconds), kept_.size()), table_);
  }

  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  const StudyRunner& runner_;
  const Study& study_;
  const std::filesystem::path folder_;
  const StopSignal signals_;
  std::atomic<bool>& stop_;
  Store store_;
  const StudyPart part_;
  const bool table_;
  const int jobs_;
  std::vector<const StudyCase*> cases_;  // of this run
  std::map<std::string, std::string> fingerprints_;
  std::map<std::string, double> predicted_;  // seconds, where cases were dealt
  std::set<std::string> kept_;               // rows that were there
  std::set<std::string> fresh_;              // rows that this run made
  std::mutex failed_mutex_;
  std::set<std::string> failed_;
  std::mutex waiting_mutex_;
  Progress* progress_ = nullptr;  // while cases run
  std::chrono::steady_clock::time_point said_waiting_;
};

}  // namespace

std::filesystem::path default_folder(const std::string& study, const StudyPart& part) {
  return std::filesystem::path("results") /
         (part.whole() ? study : fmt::format("{}-part-{}-of-{}", study, part.number, part.of));
}

int run_study_with(const StudyRunner& runner, const Study& study, const RunOptions& options) {
  const std::filesystem::path folder = options.out.empty() ? default_folder(study.name, options.part) : options.out;
  try {
    if (!options.part.whole()) check_part(study, options.part);
    return FolderRun(runner, study, options, folder).run();
  } catch (const Interrupted&) {
    return kInterrupted;
  } catch (const StoreError& error) {
    say(runner.messages, fmt::format("ricochet: {}\n", error.what()));
    return kStoreUnusable;
  }
}

namespace {

constexpr std::array<int, 5> kSignals = {SIGINT, SIGTERM, SIGUSR1, SIGHUP, SIGXFSZ};

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");
std::atomic<int> signals_seen{0};
std::array<struct sigaction, kSignals.size()> handlers_before;

extern "C" void on_stop(int signal) {
  stop_requested = true;
  // A scheduler's warning is no order, however often it comes. A terminal that closes says so twice.
  if (signal != SIGUSR1 && signal != SIGHUP && ++signals_seen > 1) ::_exit(kInterrupted);
}

}  // namespace

StopSignal::StopSignal() {
  stop_requested = false;
  signals_seen = 0;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    struct sigaction action {};
    action.sa_handler = kSignals[i] == SIGXFSZ ? SIG_IGN : on_stop;
    action.sa_flags = SA_RESTART;  // a write to the store goes on
    ::sigaction(kSignals[i], &action, &handlers_before[i]);
    // nohup: the run outlives its terminal.
    if (kSignals[i] == SIGHUP && handlers_before[i].sa_handler == SIG_IGN)
      ::sigaction(SIGHUP, &handlers_before[i], nullptr);
  }
}

StopSignal::~StopSignal() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &handlers_before[i], nullptr);
}

std::atomic<bool>& StopSignal::requested() const {
  return stop_requested;
}

}  // namespace ricochet
