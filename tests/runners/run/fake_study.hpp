#pragma once
#include <cmath>
#include <cstdio>
#include <set>
#include <string>

#include "runners/run/study_runner.hpp"
#include "tests/runners/scratch_folder.hpp"

/// A study of `count` cases over two axes, and a case function that computes nothing but always the same for the same
/// case.
inline ricochet::Study fake_study(int count) {
  ricochet::Study study;
  study.name = "fake";
  study.question = "Does the store keep what it is given?";
  study.kind = "trajectory";
  study.resolved = {{"name", "fake"}, {"cases", count}};
  study.columns = {"mass", "step"};
  for (int i = 0; i < count; ++i) {
    ricochet::StudyCase one;
    char id[16];
    std::snprintf(id, sizeof id, "c%010x", 0xabc000 + i);
    one.id = id;
    one.mass.name = i % 2 == 0 ? "even" : "odd";
    one.contact.name = "touch";
    one.time.name = "march";
    one.step = 1.0 / (i + 3);
    one.axes = {{"mass", one.mass.name}, {"step", one.step}};
    one.duration = 1;
    one.samples = 50;
    study.cases.push_back(std::move(one));
  }
  return study;
}

inline ricochet::CaseRecord fake_result(const ricochet::StudyCase& one) {
  ricochet::CaseRecord record;
  record.status = ricochet::Status::done;
  record.steps = std::lround(one.duration / one.step);
  record.measures = {{"energy_start", 2.0}, {"energy_end", 2.0 - one.step}, {"impacts", 3}};
  record.left_out = {{"load", "the load is 0"}};
  record.notes = {"nothing was computed"};
  record.operator_name = "band";
  record.curve.names = {"t", "energy"};
  record.curve.columns.resize(2);
  for (int i = 0; i < one.samples; ++i) {
    record.curve.columns[0].push_back(i * one.step);
    record.curve.columns[1].push_back(std::sin(i * one.step));
  }
  return record;
}

/// What a run is given, and what it said: messages and summary go to files of the scratch folder.
class FakeRun {
 public:
  explicit FakeRun(const ScratchFolder& scratch) : FakeRun(scratch.path()) {}
  explicit FakeRun(const std::filesystem::path& scratch) : said_(scratch / "said.txt"), told_(scratch / "told.txt") {
    runner.plan = [](const ricochet::StudyCase&) { return ricochet::CasePlan{}; };
    runner.cases.run = [this](const ricochet::StudyCase& one, const std::atomic<bool>&) {
      ++runs;
      return fake_result(one);
    };
    runner.libraries = [](const ricochet::StudyCase&) { return std::vector<std::filesystem::path>{}; };
    runner.environment = [] { return ricochet::Environment{{{"program", "fake"}}}; };
    runner.render = [](const ricochet::StudyResults& results) {
      return "<html>" + std::to_string(results.cases.size()) + " cases</html>\n";
    };
  }

  int operator()(const ricochet::Study& study, const ricochet::RunOptions& options) {
    runs = 0;
    runner.out = std::fopen(said_.c_str(), "w");
    runner.messages = std::fopen(told_.c_str(), "w");
    const int code = ricochet::run_study_with(runner, study, options);
    std::fclose(runner.out);
    std::fclose(runner.messages);
    summary = read_text(said_);
    messages = read_text(told_);
    return code;
  }

  ricochet::StudyRunner runner;
  std::atomic<int> runs{0};  ///< cases run by the last call
  std::string summary, messages;

 private:
  std::filesystem::path said_, told_;
};
