#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <map>
#include <mutex>
#include <ricochet/contract/errors.hpp>
#include <ricochet/measure/statistics/quantiles.hpp>
#include <span>

#include "runners/march/prepare_case.hpp"
#include "runners/march/seconds.hpp"
#include "runners/run/on_threads.hpp"
#include "runners/run/plan_cases.hpp"
#include "runners/run/say.hpp"
#include "runners/run/study_runner.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet {
namespace {

// One of cases that are alike is planned; where that tells nothing (it may be refused), a few more.
constexpr std::size_t most_tried = 16;

// What travels to a worker together: a message costs a part of a millisecond.
constexpr double least_seconds = 0.05;
constexpr std::size_t most_together = 64;

/// Runs cases one after the other; `ended` is told each record.
void run_together(const CaseRunner& runner, std::span<const PendingCase> cases, const std::atomic<bool>& stop,
                  const std::function<void(const CaseRecord&)>& ended) {
  if (cases.size() == 1) return ended(run_guarded(runner, *cases.front().study_case, stop));
  std::vector<const StudyCase*> all;
  for (const PendingCase& one : cases) all.push_back(one.study_case);
  runner.run_several(all, ended, stop);
}

}  // namespace

int run_cases(const StudyRunner& runner, std::vector<PendingCase> pending, int at_once, std::atomic<bool>& stop,
              const CaseEvents& events) {
  // Of very many cases those that cost the same run in the order of their ids, in which the store keeps them. Cases
  // that end together then share pages of the store: fewer pages are written anew.
  const bool by_id = pending.size() > 2000;
  std::stable_sort(pending.begin(), pending.end(), [&](const PendingCase& a, const PendingCase& b) {
    if (a.predicted_seconds != b.predicted_seconds) return a.predicted_seconds > b.predicted_seconds;
    return by_id && a.study_case->id < b.study_case->id;
  });
  at_once = std::max(1, std::min(at_once, static_cast<int>(pending.size())));
  std::size_t next = 0;
  std::mutex taking;
  // None where all are taken.
  const auto take = [&] {
    const std::lock_guard guard(taking);
    const std::size_t left = pending.size() - next, shares = 4 * static_cast<std::size_t>(at_once);
    const std::size_t most = runner.cases.run_several ? std::clamp(left / shares, std::size_t{1}, most_together) : 1;
    const std::size_t first = next;
    double seconds = 0;
    while (!stop && next < pending.size() && next - first < most && seconds < least_seconds) {
      const double predicted = pending[next++].predicted_seconds;
      seconds += predicted > 0 ? predicted : least_seconds;  // of what nobody predicted, one at a time
    }
    return std::span<const PendingCase>(pending).subspan(first, next - first);
  };
  std::atomic<int> finished{0};
  std::mutex failing;
  std::exception_ptr failure;
  on_threads(at_once, [&] {
    try {
      for (std::span<const PendingCase> cases = take(); !cases.empty(); cases = take()) {
        events.begins(cases);
        std::size_t ended = 0;
        run_together(runner.cases, cases, stop, [&](const CaseRecord& record) {
          ++ended;
          events.finished(record, ended < cases.size() ? &cases[ended] : nullptr);
          ++finished;
        });
      }
    } catch (const Interrupted&) {
    } catch (...) {
      const std::lock_guard guard(failing);
      if (!failure) failure = std::current_exception();
      stop = true;
    }
  });
  if (failure) std::rethrow_exception(failure);
  return finished;
}

void predict_cases(const StudyRunner& runner, std::vector<PendingCase>& pending, int at_once,
                   const std::atomic<bool>& stop) {
  InOrderMet<std::string, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < pending.size(); ++i) groups[cost_key(*pending[i].study_case)].push_back(i);
  std::vector<std::vector<std::size_t>> all;  // which are alike, in the study's order
  for (auto& [key, alike] : std::move(groups).list()) all.push_back(std::move(alike));
  std::atomic<std::size_t> next{0};
  std::atomic<bool> some{false};
  std::mutex first;
  std::exception_ptr wrong;
  on_threads(std::max(1, std::min(at_once, static_cast<int>(all.size()))), [&] {
    for (std::size_t group = next++; group < all.size() && !stop; group = next++) {
      const std::vector<std::size_t>& alike = all[group];
      double seconds = 0;
      for (std::size_t k = 0; k < std::min(alike.size(), most_tried) && seconds == 0 && !stop; ++k) try {
          seconds = std::max(0.0, runner.plan(*pending[alike[k]].study_case).predicted_seconds);
          some = true;
        } catch (const InputError&) {
          const std::lock_guard lock(first);
          if (!wrong) wrong = std::current_exception();
        } catch (...) {
          // A prediction that cannot be made says nothing about the case: running it will.
          some = true;
        }
      for (const std::size_t i : alike) pending[i].predicted_seconds = seconds;
    }
  });
  // Where the input of every case is wrong the study is.
  if (wrong && !some && !stop) std::rethrow_exception(wrong);
}

namespace {

bool timed(const CaseRecord& record) {
  return std::any_of(record.measures.begin(), record.measures.end(),
                     [](const auto& measure) { return measure.first == "timed_seconds"; });
}

}  // namespace

std::vector<CaseRecord> time_cases(const StudyRunner& runner, const Study& study, const StudyResults& results,
                                   int repeats, const std::atomic<bool>& stop) {
  std::map<std::string, const StudyCase*> cases;
  for (const StudyCase& one : study.cases) cases[one.id] = &one;
  std::vector<CaseRecord> records;
  for (const CaseRecord& record : results.cases)
    if (record.status == Status::done && !timed(record) && cases.count(record.id)) records.push_back(record);
  if (records.empty()) return {};
  double expected = 0;
  for (const CaseRecord& record : records) expected += record.run_seconds;
  say(runner.messages, fmt::format("timing {} cases {} times, one at a time: about {:.0f} s\n", records.size(), repeats,
                                   expected * repeats));

  std::vector<std::vector<double>> seconds(records.size());
  double busy = 0;
  const auto wall = std::chrono::steady_clock::now();
  for (int round = 0; round < repeats; ++round)
    for (std::size_t i = 0; i < records.size(); ++i) {
      if (stop) return {};
      const StudyCase& one = *cases.at(records[i].id);
      try {
        if (const auto time = runner.cases.time(one, stop)) {
          seconds[i].push_back(time->marching);
          busy += time->processor;
        }
      } catch (const Interrupted&) {
        return {};
      } catch (...) {
        // It ran before: what fails now is its time alone.
      }
    }
  // One of ours is busy at a time: the rest of the wall time went to others.
  const double passed = seconds_since(wall);
  const double share = passed > 0 ? 1 - busy / passed : 0;
  constexpr double loaded = 0.1;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (seconds[i].empty()) continue;
    const auto [low, high] = std::minmax_element(seconds[i].begin(), seconds[i].end());
    records[i].measures.emplace_back("timed_seconds", median(seconds[i]));
    records[i].measures.emplace_back("timed_low", *low);
    records[i].measures.emplace_back("timed_high", *high);
    if (share > loaded)
      records[i].notes.push_back(fmt::format(
          "the machine was loaded while cases were timed: {:.0f} % of the time went to other programs", 100 * share));
  }
  return records;
}

}  // namespace ricochet
