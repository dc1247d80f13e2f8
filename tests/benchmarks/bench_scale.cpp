// What a run on many workers rests on: the time of two workers against that of one, and what the coordinator takes in.
// The coordinator and its store are measured with workers that cost nothing.
//
//     bench_scale [CELLS_PER_SIDE [ROUNDS [STUDY.json]]]
//
// The cells that cost nothing end as one that is marched. Once that is a motion of period 1, of which a point is kept,
// once a quasi-periodic one, of which 64 are. Wall times of whole runs in new folders, interleaved, medians; the
// machine should have nothing else to do.
#include <fmt/format.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/measure/statistics/quantiles.hpp>
#include <thread>

#include "runners/kinds/kind.hpp"
#include "runners/kinds/sweep/block_orders.hpp"
#include "runners/march/seconds.hpp"
#include "runners/march/study_identity.hpp"
#include "runners/report/report.hpp"
#include "runners/run/analysed_results.hpp"
#include "runners/run/asked_text.hpp"
#include "runners/run/study_runner.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/store/store.hpp"
#include "runners/study/load_study.hpp"
#include "tests/places.hpp"

namespace {

using namespace ricochet;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double processor_seconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

double largest_memory() {  // bytes
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return 1024.0 * static_cast<double>(used.ru_maxrss);
}

/// A thousand workers that cost nothing: the first orbit that they are given is marched, all others end as it did.
class Echo : public BlockService {
 public:
  Echo(const StudyCase& study_case, const Registry& registry)
      : case_(study_case), marcher_(registry), thread_([this] { answer(); }) {}
  ~Echo() override {
    {
      const std::lock_guard guard(mutex_);
      ending_ = true;
    }
    asked_.notify_all();
    thread_.join();
  }

  int width() const override { return 1000; }
  int share() const override { return 1000; }
  int begin(const std::string&, const std::string& order, std::function<void(BlockStatus)> heard) override {
    const std::lock_guard guard(mutex_);
    waiting_.push_back({order, std::move(heard)});
    asked_.notify_one();
    return begun_++;
  }
  void stop(int) override {}

  std::atomic<double> seconds{0};  ///< of processor time, its own
  std::atomic<long long> messages{0}, bytes{0};

 private:
  struct Asked {
    std::string order;
    std::function<void(BlockStatus)> heard;
  };

  void answer() {
    for (;;) {
      std::unique_lock lock(mutex_);
      asked_.wait(lock, [&] { return ending_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      Asked asked = std::move(waiting_.front());
      waiting_.pop_front();
      lock.unlock();
      BlockOrder order = block_order(asked.order);
      if (!known_) march_one(order);
      BlockAnswer told;
      for (std::size_t i = 0; i < order.orbits.size(); ++i) {
        told.marched.finished.push_back(*known_);
        told.marched.finished.back().task = static_cast<int>(i);
      }
      BlockStatus all{.what = BlockStatus::What::so_far, .content = to_bytes(told)};
      BlockStatus end{.what = BlockStatus::What::done, .content = to_bytes(BlockAnswer{})};
      messages += 3;
      bytes += static_cast<long long>(asked.order.size() + all.content.size() + end.content.size());
      seconds = thread_seconds();
      asked.heard(std::move(all));
      asked.heard(std::move(end));
    }
  }

  void march_one(BlockOrder order) {
    order.orbits.resize(1);
    order.leave = 0;
    const std::atomic<bool> stop = false;
    const auto keep = [&](const std::string& told) {
      for (const Orbit& orbit : block_answer(told).marched.finished) known_ = orbit;
    };
    marcher_.march(case_, to_bytes(order), keep, stop);
  }

  const StudyCase& case_;
  BlockMarcher marcher_;
  std::mutex mutex_;
  std::condition_variable asked_;
  std::deque<Asked> waiting_;
  int begun_ = 0;
  bool ending_ = false;
  std::optional<Orbit> known_;
  std::thread thread_;
};

/// Cells of which the first begins at this displacement.
std::string grid(int side, double from) {
  return fmt::format(R"({{
  "name": "echoes", "kind": "basins",
  "scene": {{
    "structure": {{"type": "beam", "length": 1.501, "young": 2.0e11, "density": 8000,
                  "section": {{"type": "tube", "outer_diameter": 0.01, "wall": 0.0005}}, "damping": {{"stiffness": 1e-4}}}},
    "stops": {{"lower": -0.1, "upper": 0.1, "at": "tip"}},
    "support": {{"amplitude": 0.07, "pulsation": 10}},
    "initial": {{"displacement": "0.1*(x/1.501)^2", "velocity": "x/1.501"}}
  }},
  "mesh": {{"elements": 10}},
  "methods": {{"mass": "consistent", "contact": "signorini", "time": {{"name": "newmark-dumont-paoli", "beta": 0.5}}}},
  "axes": [{{"pointer": "/scene/initial/displacement", "from": {1}, "to": 1, "count": {0}}},
           {{"pointer": "/scene/initial/velocity", "from": -2, "to": 2, "count": {0}}}],
  "steps_per_period": 500, "transient": {{"periods": 40, "at_most": 200}}, "keep": 64
}})",
                     side, from);
}

/// The coordinator, its store, its tables and its report, on `side`² cells that nobody marches.
void coordinator(int side, double from, const fs::path& folder) {
  Catalogue catalogue(fs::path(tests::places().plugins), {}, {});
  Registry registry;
  const Study study = parse_study(grid(side, from), catalogue, registry);
  Echo echo(study.cases.front(), registry);
  const RunContext context{study, registry, [](const StudyCase& one) { return one.id; }, &echo};
  StudyRunner runner;
  runner.libraries = [](const StudyCase&) { return std::vector<fs::path>(); };
  runner.cases = find_kind("basins")->start(context);
  runner.plan = [&](const StudyCase& one) { return find_kind("basins")->plan(one, registry); };
  runner.environment = [] { return Environment(); };
  double reported = 0;
  runner.render = [&](const AnalysedResults& results) {
    const double begin = processor_seconds();
    std::string page = render_report(results.choices, page_of_study(results));
    reported += processor_seconds() - begin;
    return page;
  };
  runner.out = std::fopen("/dev/null", "w");
  runner.messages = runner.out;
  RunOptions options;
  options.out = folder;
  options.jobs = 1;
  const auto begin = Clock::now();
  const double before = processor_seconds();
  run_study_with(runner, study, options);
  const double wall = seconds_since(begin), spent = processor_seconds() - before - echo.seconds;
  std::fclose(runner.out);
  const double cells = static_cast<double>(side) * side;
  std::uintmax_t store = 0, page = 0;
  for (const auto& file : fs::directory_iterator(folder)) {
    if (file.path().filename() == "results.sqlite") store = file.file_size();
    if (file.path().filename() == "report.html") page = file.file_size();
  }
  const StudyResults results = read_store(folder);
  const NumberTable* points = find_table(results.cases.front().numbers, "cell_points");
  std::cout << fmt::format(
      "coordinator, store, tables and report of {:.0f} cells that cost nothing, {:.0f} points of each: {:.1f} s of "
      "wall "
      "time, {:.1f} s of one processor (the page {:.1f}), {:.1f} µs per cell\n"
      "  {} messages, {:.1f} MB; memory at most {:.0f} MB; store {:.1f} MB, page {:.2f} MB\n"
      "  {:.0f} cells per second: it feeds 1000 workers where a cell takes {:.1f} ms or more\n",
      cells, points ? static_cast<double>(points->rows()) / cells : 0.0, wall, spent, reported, 1e6 * spent / cells,
      echo.messages.load(), 1e-6 * static_cast<double>(echo.bytes), 1e-6 * largest_memory(),
      1e-6 * static_cast<double>(store), 1e-6 * static_cast<double>(page), cells / spent, 1e6 * spent / cells);
}

double run_seconds(const std::string& study, const fs::path& folder, const std::string& options) {
  fs::remove_all(folder);
  const auto begin = Clock::now();
  const std::string command = fmt::format("'{}' run '{}' --out '{}' {} > /dev/null 2>&1", tests::places().command,
                                          study, folder.string(), options);
  const int code = std::system(command.c_str());
  if (code != 0) std::cerr << fmt::format("{}: exit code {}\n", command, code);
  return seconds_since(begin);
}

}  // namespace

int main(int argc, char** argv) {
  const int side = argc > 1 ? std::atoi(argv[1]) : 300, rounds = argc > 2 ? std::atoi(argv[2]) : 3;
  const std::string study = argc > 3 ? argv[3] : tests::places().source + "/studies/bifurcation-beta-quick.json";
  const fs::path scratch = fs::temp_directory_path() / fmt::format("bench-scale-{}", ::getpid());
  fs::create_directories(scratch);
  for (const double from : {-0.75, -1.0})
    if (side > 0) coordinator(side, from, scratch / fmt::format("echoes{}", from));
  const std::vector<std::string> ways = {"--inline", "--isolate --jobs 1", "--isolate --jobs 2"};
  std::map<std::string, std::vector<double>> taken;
  for (int round = 0; round < rounds; ++round)
    for (const std::string& way : ways) taken[way].push_back(run_seconds(study, scratch / "run", way));
  if (rounds > 0) {
    const auto of = [&](int way) { return median(taken[ways[static_cast<std::size_t>(way)]]); };
    std::cout << fmt::format("{}, medians of {} rounds:\n", fs::path(study).filename().string(), rounds);
    for (const std::string& way : ways) std::cout << fmt::format("  {:20s} {:.2f} s\n", way, median(taken[way]));
    std::cout << fmt::format("two workers are {:.2f} of ideal; one worker takes {:.3f} of the time of one process\n",
                             of(1) / (2 * of(2)), of(1) / of(0));
  }
  fs::remove_all(scratch);
}
