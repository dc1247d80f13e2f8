#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <ricochet/contract/registry.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "runners/answers/answer.hpp"
#include "runners/asks/answer_asks.hpp"
#include "runners/march/case_context.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/report/kind_page.hpp"
#include "runners/store/record.hpp"
#include "runners/study/study_kind.hpp"

namespace ricochet {

/// What a kind may use to run the cases of one study. It outlives them.
struct RunContext {
  const Study& study;
  const Registry& registry;
  std::function<std::string(const StudyCase&)> key;  ///< of a case and everything that its results depend on
  BlockService* blocks = nullptr;                    ///< what marches blocks of a case elsewhere; null: nothing does
};

/// A case that was marched once more, alone, processor seconds.
struct TimedMarch {
  double marching = 0, processor = 0;  ///< of its steps; of all that it took
};

/// How the cases of one study run.
struct CaseRunner {
  /// Runs one case; throws Interrupted where `stop` became true.
  std::function<CaseRecord(const StudyCase&, const std::atomic<bool>& stop)> run;
  /// Runs cases that cost little, one after the other, with one message to a worker; `ended` is told each record in
  /// order, with id and axes, one of status `failed` too. Throws Interrupted where `stop` became true. Empty: cases run
  /// one by one.
  std::function<void(const std::vector<const StudyCase*>&, const std::function<void(CaseRecord)>& ended,
                     const std::atomic<bool>& stop)>
      run_several;
  /// Called once, when the store is open and before any case runs; throws InputError for what only shows then. May be
  /// empty.
  std::function<void(CheckpointStore, const std::atomic<bool>& stop)> open;
  /// Marches one case alone; empty: cases of this kind are not timed apart.
  std::function<std::optional<TimedMarch>(const StudyCase&, const std::atomic<bool>& stop)> time;
  /// Marches a block that a case of another process began by its BlockService, `so_far` being told what would be lost;
  /// returns the answer. Throws Interrupted where `stop` became true. Empty: cases are not cut into blocks.
  std::function<std::string(const StudyCase&, const std::string& order, const std::function<void(std::string)>& so_far,
                            const std::atomic<bool>& stop)>
      block;
};

/// Runs one case and makes a record of whatever happens: what it throws becomes status `failed`. Only Interrupted and
/// RunError go through.
CaseRecord run_guarded(const CaseRunner& cases, const StudyCase& study_case, const std::atomic<bool>& stop);

/// One point of a stored study that is to be marched again.
struct PointRequest {
  std::string case_id;                         ///< or the beginning of one
  std::vector<std::filesystem::path> plugins;  ///< libraries beside the program's own
  std::optional<double> parameter;
  std::string start, cell;       ///< "" where none is given
  int periods = 0, samples = 0;  ///< 0 where none is given
  std::string branch;            ///< of a study of branches
  std::optional<double> arc;
  int snapshots = 0;                         ///< 0 where none is given
  std::filesystem::path folder;              ///< of the results
  std::optional<std::filesystem::path> out;  ///< file of its own
  /// Whether there are words that a branch has no use for, or words of branches alone.
  bool marches() const { return parameter || !start.empty() || !cell.empty() || periods > 0 || samples > 0; }
  bool solves() const { return !branch.empty() || arc || snapshots > 0 || out; }
};

/// Why a point cannot be marched again: the message is complete.
class PointRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a forecast of a study's cost rests on.
struct ForecastContext {
  const Study& study;
  const Registry& registry;
  std::vector<const StudyCase*> cases;                   ///< those that would run
  std::function<double(const StudyCase&)> step_seconds;  ///< of one marched step of a case
};

/// What a kind makes of the results of one study, once: what its answer and its page ask. It may refer to the results,
/// which outlive it.
struct Analysis {
  report::KindPage page = {};   ///< what its reports show; empty: what every page has
  asks::OwnAnswers verbs = {};  ///< the verbs that its kind declares (StudyKind::verbs) or tells more of
};

/// A kind of study, all that the program knows of it.
class Kind {
 public:
  virtual ~Kind() = default;

  const StudyKind format;                   ///< its name, its keys, and what it adds to a case
  const std::vector<MeasureInfo> measures;  ///< those that it adds to those of the kinds registered before it

  /// What would run for a case, decided without running it.
  virtual CasePlan plan(const StudyCase& study_case, const Registry& registry) const = 0;
  /// What runs the cases of a study.
  virtual CaseRunner start(const RunContext& context) const = 0;

  /// Whether a study takes more than the marches of its cases: references, repeats.
  virtual bool works_beside() const { return false; }
  /// Processor seconds of that.
  virtual double beside(const ForecastContext&) const { return 0; }

  /// Whether a case is one integration of its scene.
  virtual bool marches_once() const { return false; }
  /// Marches the scene of one case once, with its curve, whatever else the kind makes of it. Throws std::logic_error
  /// where a case is more than that.
  virtual CaseRecord march(const StudyCase& study_case, const Registry& registry, const std::atomic<bool>& stop) const;

  /// Appends the tables that follow from the cases to results.derived: those that the cases carry. `study`: the same
  /// results as a comparison.
  virtual Analysis analysis(StudyResults& results, const Choices& study) const;
  /// The measures that an answer is made of where the study names none.
  virtual std::vector<std::string> observed(const StudyResults&) const { return {}; }
  /// `curves` without rows: the sampled series that a case leaves in curves/ID.csv. Without columns: none.
  virtual Table curve(const StudyResults&) const { return {}; }
  /// What a finished case has to say, in the terminal: "tip-l2 1.2e-05". "": nothing.
  virtual std::string outcome(const CaseRecord&) const { return ""; }
  /// What is wrong with a finished case that contradicts itself, for the totals and the exit code: "spectrum and march
  /// disagree". "": nothing.
  virtual std::string contradiction(const CaseRecord&) const { return ""; }
  /// Whether its measures stand in cases.csv even where no case has one.
  virtual bool measures_stand() const { return false; }
  /// A study of one case alone, to be looked at; null where the case cannot be repeated alone.
  virtual nlohmann::ordered_json alone(const StudyResults&, const CaseRecord&) const { return nullptr; }

  /// Whether a stored study has points that can be marched again.
  virtual bool has_points() const { return false; }
  /// Whether a case is so many that `case` never computes all of them again.
  virtual bool only_points() const { return has_points(); }
  /// Marches one of them, samples to `out`; returns the exit code. Throws PointRefused.
  virtual int point(const StudyResults& results, const PointRequest& asked, std::ostream& out) const;

 protected:
  explicit Kind(StudyKind of_studies, std::vector<MeasureInfo> of_cases = {})
      : format(std::move(of_studies)), measures(std::move(of_cases)) {}
  Kind(const Kind&) = delete;
};

using KindPointer = std::unique_ptr<const Kind>;

/// The kinds of the program, in the order in which they are told.
const std::vector<KindPointer>& kinds();
/// Adds a kind; to be called before any study is read. Throws std::logic_error for a name that is taken.
void add_kind(KindPointer kind);
/// The kind of this name; null where there is none.
const Kind* find_kind(const std::string& name);

/// Appends the tables that cases carry to results.derived, each row behind its case's axes. `left_out` (may be empty)
/// names those that the kind derives itself.
void collect_tables(StudyResults& results, const std::function<bool(const std::string& table)>& left_out = {});

}  // namespace ricochet
