#include "runners/run/finish_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "runners/answers/answer.hpp"
#include "runners/answers/numbers_in_words.hpp"
#include "runners/asks/default_asks.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/report/choices.hpp"
#include "runners/report/html.hpp"
#include "runners/report/summary_page.hpp"
#include "runners/run/asked_text.hpp"
#include "runners/run/choice_effects.hpp"
#include "runners/run/exit_code.hpp"
#include "runners/run/say.hpp"
#include "runners/run/study_runner.hpp"
#include "runners/run/waiting_line.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/checksums.hpp"
#include "runners/store/read_store.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/store.hpp"
#include "runners/store/study_tables.hpp"
#include "runners/table/in_order_met.hpp"
#include "runners/table/table_reader.hpp"
#include "runners/table/text.hpp"

namespace ricochet {

namespace {

Analysis analysis_of(StudyResults& results, const Choices& study) {
  results.derived.clear();
  const Kind* kind = find_kind(results.kind);
  if (kind) return kind->analysis(results, study);
  collect_tables(results);
  return {};
}

constexpr const char* status_asked = "status";

std::vector<std::string> observed_by_name(const StudyResults& results) {
  const auto given = results.study.find("observe");
  const bool list = given != results.study.end() && given->is_array();
  return list ? given->get<std::vector<std::string>>() : std::vector<std::string>{};
}

/// What the study asks, or what its kind asks where it asks nothing.
asks::Asked asked_of(const StudyResults& results, const Choices& choices, const Analysis& analysis) {
  const asks::Evidence evidence(choices);
  const std::vector<asks::Ask> given = asks::asks_of(results.study);
  if (!given.empty()) return asks::answer_asks(given, evidence, analysis.verbs);
  const Kind* kind = find_kind(results.kind);
  if (kind && kind->format.default_asks)
    return asks::answer_asks(asks::asks_of_list(kind->format.default_asks(results.study)), evidence, analysis.verbs);
  const std::vector<std::string> names = observed_by_name(results), measures = observed_measures(results);
  const bool runs = std::find(names.begin(), names.end(), status_asked) != names.end() || measures.empty();
  asks::Asked out = asks::answer_asks(asks::asks_of_measures(evidence, measures, runs), evidence, analysis.verbs);
  out.proposed = asks::proposals(evidence, measures);
  return out;
}

}  // namespace

AnalysedResults::AnalysedResults(StudyResults results)
    : StudyResults(std::move(results)),
      choices(*this),
      analysis(analysis_of(*this, choices)),
      asked(asked_of(*this, choices, analysis)) {
  // The answer says the shares, and stands before them.
  const auto before_shares = static_cast<std::ptrdiff_t>(derived.size());
  const auto add = [&](Table table) {
    if (!table.rows.empty()) derived.push_back(std::move(table));
  };
  add(effects_table(*this));
  if (const Kind* of_study = find_kind(kind); !of_study || !of_study->format.default_asks)
    for (Table& table : evidence_tables(choices)) add(std::move(table));
  for (Table table : {asked_table(choices, asked), asks::verdicts_table(asked)})
    if (!table.rows.empty()) derived.insert(derived.begin() + before_shares, std::move(table));
  add(reasons_table(*this));
  for (Table& table : report::page_tables(choices, analysis.page)) add(std::move(table));
}

Table reasons_table(const StudyResults& results) {
  std::vector<std::pair<std::pair<Status, std::string>, Cases>> groups;  // by status and reason
  for (const answers::Doubt& doubt : answers::doubts_of(results))
    groups.emplace_back(std::pair(Status::done, doubt.text), doubt.cases);
  for (const CaseRecord& record : results.cases)
    if (!record.partial && record.status != Status::done)
      in_order_met(groups, std::pair(record.status, record.reason())).push_back(&record);
  const auto first = [&](const auto& group) { return group.second.front(); };
  std::stable_sort(groups.begin(), groups.end(), [&](const auto& a, const auto& b) { return first(a) < first(b); });
  std::vector<ReasonRow> rows;
  for (const auto& [said, cases] : groups)
    rows.push_back({word(said.first), said.second, cases.size(), cases.front()->id});
  return reasons_type().with(rows);
}

std::unique_ptr<const AnalysedResults> write_folder(Store& store, const std::filesystem::path& folder,
                                                    const RenderReport& render, const std::set<std::string>* changed,
                                                    std::FILE* messages) {
  const WaitingLine waiting("making tables and report", messages);
  auto results = std::make_unique<const AnalysedResults>(store.load());
  store.make_views(*results);
  write_outputs(
      folder, *results, [&] { return render(*results); }, changed);
  return results;
}

namespace {

bool nothing_ran(const StudyResults& results) {
  return !results.cases.empty() && std::all_of(results.cases.begin(), results.cases.end(),
                                               [](const CaseRecord& one) { return one.status == Status::refused; });
}

/// With what `run` and `report` end: what went wrong, then an ask that has no yes.
int asked_exit_code(const AnalysedResults& results) {
  const int code = results_exit_code(results);
  return code == exit_done && !results.asked.unmet().empty() ? exit_not_met : code;
}

}  // namespace

int tell_results(std::FILE* out, const AnalysedResults& results, const std::filesystem::path& folder,
                 const std::string& how, bool table) {
  const bool nothing = nothing_ran(results);
  const std::string answer = asked_text(results);
  const int code = results_exit_code(results);
  say(out, fmt::format("{}{}\n{} ({})\nreport: {}\n", table ? case_table(results) + "\n" : "", answer,
                       totals_text(results), how, (folder / "report.html").string()));
  for (const asks::Ask* ask : results.asked.unmet())
    say(out, fmt::format("{}ask {} requires a yes and has none\n",
                         code == 0 ? fmt::format("exit code {}: ", static_cast<int>(exit_not_met)) : "", ask->number));
  if (nothing)
    say(out, "nothing ran: every case is refused; the reasons above and in the report say what to change\n");
  else if (code != 0)
    say(out, std::any_of(results.cases.begin(), results.cases.end(), went_wrong)
                 ? fmt::format("exit code {}: {}; {} holds a study of each alone\n", code,
                               std::any_of(results.cases.begin(), results.cases.end(),
                                           [](const CaseRecord& one) { return one.status == Status::done; })
                                   ? "some cases diverged or failed, the others are usable"
                                   : "no case came to its end, some diverged or failed",
                               (folder / "failures").string())
                 : fmt::format("exit code {}: the methods of some cases are in error\n", code));
  return asked_exit_code(results);
}

// What is made of a folder's store alone: its report and tables anew, or the tables elsewhere.

namespace {

/// 0, or the code of a store that cannot be used, with its cause said.
int unless_unusable(const std::function<int()>& work) {
  try {
    return work();
  } catch (const StoreError& error) {
    say(stderr, fmt::format("ricochet: {}\n", error.what()));
    return exit_store;
  } catch (const nlohmann::json::exception& error) {
    // A study that no program wrote: one that did is checked by its checksum.
    say(stderr, fmt::format("ricochet: what the store says of its study cannot be ({})\n", error.what()));
    return exit_store;
  }
}

/// After all that is whole is written.
void tell_damage(const std::filesystem::path& folder, const StudyResults& results) {
  if (results.damage.any()) throw StoreError(damage_text(folder / "results.sqlite", results.damage));
}

}  // namespace

int rebuild_report_with(const RenderReport& render, const std::filesystem::path& folder, bool json) {
  return unless_unusable([&] {
    std::optional<WaitingLine> waiting(std::in_place, "making tables and report");
    const AnalysedResults results(read_what_is_whole(folder));
    write_outputs(folder, results, [&] { return render(results); });
    waiting.reset();
    say(stdout, json ? asked_json(results).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n"
                     : fmt::format("{}\nreport: {}\n", totals_text(results), (folder / "report.html").string()));
    tell_damage(folder, results);
    return asked_exit_code(results);
  });
}

int export_tables(const std::filesystem::path& folder, const std::filesystem::path& to, bool one_file) {
  return unless_unusable([&] {
    std::optional<WaitingLine> waiting(std::in_place, "making tables");
    const StudyResults results = with_tables(read_what_is_whole(folder));
    write_tables(to, results, one_file);
    waiting.reset();
    say(stdout, fmt::format("tables: {}\n", to.string()));
    if (!one_file && !has_curve_files(results))
      say(stdout,
          fmt::format("curves: not written, for more than {} cases have one; --curves writes them all into one file\n",
                      kMostCurveFiles));
    tell_damage(folder, results);
    return 0;
  });
}

std::vector<std::string> observed_measures(const StudyResults& results) {
  std::vector<std::string> names = observed_by_name(results);
  std::erase(names, status_asked);
  const Kind* kind = find_kind(results.kind);
  if (names.empty() && kind) names = kind->observed(results);
  std::erase_if(names, [&](const std::string& name) {
    return std::none_of(results.cases.begin(), results.cases.end(),
                        [&](const CaseRecord& one) { return one.status == Status::done && measure(one, name); });
  });
  return names;
}

Table asked_table(const Choices& study, const asks::Asked& asked) {
  answers::Answer answer;
  const auto say = [&](const std::string& text, const char* status) {
    answer.say(text, answers::Clause{.form = "asked", .status = status});
  };
  for (const std::string& one : asked.first) say(one, "first");
  for (const auto& [ask, answered] : asked.all) say(answered.sentence, answered.verdict.c_str());
  for (const answers::Sentence& doubt : answers::doubted(study)) answer.say(doubt);
  for (const auto& [ask, answered] : asked.all)
    for (const std::string& one : answered.aside)
      if (std::none_of(answer.sentences.begin(), answer.sentences.end(),
                       [&](const auto& said) { return said.text == one; }))
        say(one, "aside");
  return answer.table();
}

std::vector<Table> evidence_tables(const Choices& study) {
  const std::vector<std::string> measures = observed_measures(study.results());
  return {answers::limits_table(study, measures), answers::refinements_table(study, measures),
          answers::differences_table(study, measures)};
}

namespace {

std::string cell(const CaseRecord& record, const std::string& column) {
  return axis(record, column).text();
}

// What is wrong with the finished cases, and with how many of them.
std::map<std::string, int> contradictions(const StudyResults& results) {
  std::map<std::string, int> found;
  const Kind* kind = find_kind(results.kind);
  if (kind)
    for (const CaseRecord& record : results.cases)
      if (const std::string wrong = kind->contradiction(record); !wrong.empty()) ++found[wrong];
  return found;
}

int count(const StudyResults& results, Status status) {
  return static_cast<int>(std::count_if(results.cases.begin(), results.cases.end(), [&](const CaseRecord& record) {
    return !record.partial && record.status == status;
  }));
}

}  // namespace

std::string outcome_text(const CaseRecord& record, const std::string& kind) {
  const std::string reason = record.reason();
  if (record.partial) return reason;
  if (record.status == Status::done) {
    const Kind* known = find_kind(kind);
    const std::string own = known ? known->outcome(record) : "";
    std::string text = own.empty() ? "done" : "done: " + own;
    if (!reason.empty()) text += (own.empty() ? ": " : "; ") + reason;
    return text;
  }
  return reason.empty() ? word(record.status) : fmt::format("{}: {}", word(record.status), reason);
}

std::string case_table(const StudyResults& results) {
  std::vector<std::string> header;
  for (const std::string& name : results.columns) {
    const auto differs = [&](const CaseRecord& record) {
      return cell(record, name) != cell(results.cases.front(), name);
    };
    if (std::any_of(results.cases.begin(), results.cases.end(), differs)) header.push_back(name);
  }
  const std::vector<std::string> axes = header;
  if (axes.empty()) header.emplace_back("case");
  header.emplace_back("outcome");
  TextTable table(header);
  for (const CaseRecord& record : results.cases) {
    std::vector<std::string> line;
    for (const std::string& name : axes) line.push_back(cell(record, name));
    if (axes.empty()) line.push_back(record.id);
    line.push_back(outcome_text(record, results.kind));
    table.add(std::move(line));
  }
  return table.text();
}

std::string totals_text(const StudyResults& results) {
  std::vector<std::string> parts;
  for (const auto& [status, number] : report::status_counts(results))
    parts.push_back(fmt::format("{} {}", number, word(status)));
  if (const auto number = std::count_if(results.cases.begin(), results.cases.end(),
                                        [](const CaseRecord& record) { return record.partial; }))
    parts.push_back(fmt::format("{} under way", number));
  const std::size_t cases = results.cases.size();
  std::string text =
      fmt::format("{}{} case{}", results.part.whole() ? "" : results.part.text() + ": ", cases, cases == 1 ? "" : "s");
  if (!parts.empty()) text += fmt::format(": {}", fmt::join(parts, ", "));
  for (const auto& [wrong, number] : contradictions(results)) text += fmt::format("; in {} {}", number, wrong);
  if (const int missing = results.expected_cases - static_cast<int>(cases); missing > 0)
    text += fmt::format("; {} not run yet", missing);
  return text;
}

int results_exit_code(const StudyResults& results) {
  const bool wrong = nothing_ran(results) || !contradictions(results).empty() ||
                     count(results, Status::diverged) + count(results, Status::failed) > 0;
  return wrong ? exit_some_failed : exit_done;
}

}  // namespace ricochet
