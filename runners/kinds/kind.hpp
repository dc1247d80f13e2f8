#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <ricochet/contract/registry.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "runners/answers/answer.hpp"
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

/// Runs one case and makes a record of whatever happens: what it throws becomes status `failed`. Only Interrupted goes
/// through.
CaseRecord run_guarded(const CaseRunner& cases, const StudyCase& study_case, const std::atomic<bool>& stop);

/// One point of a stored study that is to be marched again.
struct PointRequest {
  std::string case_id;                         ///< or the beginning of one
  std::vector<std::filesystem::path> plugins;  ///< libraries beside the program's own
  std::optional<double> parameter;
  std::string start, cell;       ///< "" where none is given
  int periods = 0, samples = 0;  ///< 0 where none is given
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

/// A kind of study, all that the program knows of it. Functions that may be empty say so.
struct Kind {
  StudyKind format;  ///< its name, its keys, and what it adds to a case

  /// What would run for a case, decided without running it.
  std::function<CasePlan(const StudyCase&, const Registry&)> plan;
  /// Processor seconds that a study takes beside the marches of its cases (references, repeats). Empty: none.
  std::function<double(const ForecastContext&)> beside;
  /// What runs the cases of a study.
  std::function<CaseRunner(const RunContext&)> start;

  /// Marches the scene of one case once, with its curve, whatever else the kind makes of it. Empty: its cases are more
  /// than one integration.
  std::function<CaseRecord(const StudyCase&, const Registry&, const std::atomic<bool>& stop)> march;

  /// Appends the tables that follow from the cases to results.derived. Empty: those that the cases carry.
  std::function<void(StudyResults&)> tables;
  /// The answer where this kind has its own way. Empty: methods in tiers, or choices by what they move, in the observed
  /// measures.
  std::function<answers::Answer(const StudyResults&)> answers;
  /// The measures that an answer is made of where the study names none. Empty: none.
  std::function<std::vector<std::string>(const StudyResults&)> observed;
  /// `curves` without rows: the sampled series that a case leaves in curves/ID.csv. Without columns: none.
  Table curve;
  /// What a finished case has to say, in the terminal: "tip-l2 1.2e-05". Empty, or "": nothing.
  std::function<std::string(const CaseRecord&)> outcome;
  /// What is wrong with a finished case that contradicts itself, for the totals and the exit code: "spectrum and march
  /// disagree". "": nothing. Empty: no case can.
  std::function<std::string(const CaseRecord&)> contradiction;
  /// Measures that this kind adds to those of the kinds registered before it.
  std::vector<MeasureInfo> measures;
  /// Whether its measures stand in cases.csv even where no case has one.
  bool measures_stand = false;
  /// A study of one case alone, to be looked at; null where the case cannot be repeated alone. Empty: never.
  std::function<nlohmann::ordered_json(const StudyResults&, const CaseRecord&)> alone;
  /// What its reports show; asked for when there is one to write. Empty: what every page has.
  std::function<report::KindPage()> page;
  /// Marches one point of a stored study again, samples to `out`; returns the exit code. Throws PointRefused. Empty:
  /// such a study has no points.
  std::function<int(const StudyResults&, const PointRequest&, std::ostream& out)> point;
};

/// The kinds of the program, in the order in which they are told.
const std::vector<Kind>& kinds();
/// Adds a kind; to be called before any study is read. Throws std::logic_error for a name that is taken.
void add_kind(Kind kind);
/// The kind of this name; null where there is none.
const Kind* find_kind(const std::string& name);
/// What reports of this kind show; nothing of their own where there is none of this name.
report::KindPage page_of(const std::string& kind);

}  // namespace ricochet
