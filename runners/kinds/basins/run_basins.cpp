#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ricochet/contract/said_format.hpp>
#include <ricochet/measure/attractors/attractors.hpp>
#include <ricochet/measure/attractors/basin_grid.hpp>

#include "runners/kinds/basins/basins.hpp"
#include "runners/kinds/basins/cell_scenes.hpp"
#include "runners/kinds/sweep/orbit_checkpoints.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/march/case_context.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/march/seconds.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

constexpr std::ptrdiff_t largest_batch = 4096;  // cells
constexpr std::size_t most_shown = 200000;  // of more cells nothing is shown on the way: it would be in memory twice

bool refines(const StudyCase& study_case) {
  const Json& wanted = study_case.settings.at("refine");
  return wanted.is_boolean() && wanted.get<bool>();
}

class BasinsRun {
 public:
  BasinsRun(const StudyCase& study_case, const Registry& registry, const CaseContext& context,
            const std::atomic<bool>& stop)
      : case_(study_case),
        context_(context),
        stop_(stop),
        scenes_(study_case, registry),
        columns_(scenes_.axes()[0].values.size()),
        rows_(scenes_.axes()[1].values.size()),
        refinement_(columns_, rows_, refines(study_case),
                    [this](std::size_t cell, std::size_t other) { return alike(cell, other); }),
        ends_(columns_ * rows_),
        end_of_(columns_ * rows_, -1) {
    for (const GridAxis& axis : scenes_.axes()) one_scene_ = one_scene_ && names_initial_state(axis.pointer);
  }

  CaseRecord run() {
    record_.id = case_.id;
    record_.axes = case_.axes;
    for (auto wanted = refinement_.next(); !wanted.empty() && !over_budget_; wanted = refinement_.next())
      for (auto from = wanted.begin(); from != wanted.end() && !over_budget_;) {
        std::vector<Batch> batches;
        for (; from != wanted.end() && batches.size() < at_once(); ++batches_) {
          const auto to = from + std::min<std::ptrdiff_t>(largest_batch, wanted.end() - from);
          batches.push_back({batches_, {from, to}, {}});
          from = to;
        }
        march(batches);
        for (Batch& batch : batches) take(batch.cells, std::move(batch.ends));
      }
    finish();
    for (int batch = 0; context_.checkpoints.keep && batch < batches_; ++batch)
      context_.checkpoints.keep(batch_key(batch), "");
    return std::move(record_);
  }

 private:
  /// Cells that are kept together, and their ends.
  struct Batch {
    int number = 0;
    std::vector<std::size_t> cells;
    std::vector<CellEnd> ends;  ///< empty: not known
    bool known() const { return !ends.empty(); }
  };

  std::string batch_key(int batch) const { return fmt::format("cells/{}/{}", context_.key, batch); }

  // Batches that are marched together: enough that those who march wait little for the longest orbit of them.
  std::size_t at_once() const {
    constexpr int rounds = 32, lanes = 8, most = 16;
    const int marching = context_.blocks ? context_.blocks->width() : 1;
    return static_cast<std::size_t>(std::clamp(rounds * lanes * marching / static_cast<int>(largest_batch), 1, most));
  }

  // The ends of these cells; batches that an interrupted run had finished are read.
  void march(std::vector<Batch>& batches) {
    for (Batch& batch : batches) {
      auto found = recall(context_.checkpoints, batch_key(batch.number), cell_ends);
      if (!found || found->size() != batch.cells.size()) continue;
      if (scenes_.scenes().groups() == 0) prepare_some(batch.cells);
      batch.ends = std::move(*found);
    }
    if (std::all_of(batches.begin(), batches.end(), [](const Batch& batch) { return batch.known(); })) return;
    const double begun = thread_seconds();
    scenes_.begin();
    // What is under way is found again by a run that marches the same batches together.
    std::string under_way = context_.key;
    std::vector<CellEnd*> places;  // of the tasks
    std::vector<OrbitTask> tasks;
    std::vector<Batch*> marched;
    for (Batch& batch : batches) {
      if (batch.known()) continue;
      marched.push_back(&batch);
      under_way += fmt::format("/{}", batch.number);
      batch.ends.resize(batch.cells.size());
      for (std::size_t i = 0; i < batch.cells.size(); ++i) {
        CellScenes::Prepared cell = scenes_.prepare(batch.cells[i] % columns_, batch.cells[i] / columns_);
        if (cell.refusal.empty()) {
          places.push_back(&batch.ends[i]);
          tasks.push_back(std::move(cell.task));
        } else {
          batch.ends[i] = cell.no_start ? no_start_end(cell.refusal) : refused_end(cell.refusal);
        }
      }
    }
    record_.setup_seconds += thread_seconds() - begun;
    if (tasks.empty()) return;
    describe_methods();
    OrbitScheduler scheduler(scenes_.scenes(), {.section = section_,
                                                .budget = budget_of(case_) - record_.run_seconds,
                                                .ends_only = true,
                                                .blocks = context_.blocks,
                                                .case_id = case_.id});
    for (OrbitTask& task : tasks) scheduler.add(std::move(task));
    OrbitCheckpoints checkpoints(context_.checkpoints, under_way);
    MarchedOrbits found = checkpoints.find();
    std::size_t ended = found.finished.size();
    scheduler.restore(std::move(found));
    scheduler.run(stop_, [&](const MarchedOrbits& so_far) {
      ended += so_far.finished.size();
      if (ended < places.size()) checkpoints.save(so_far);  // else the batches are kept at once
      show_partial();
    });
    record_.run_seconds += scheduler.seconds();
    lane_periods_ += scheduler.lane_periods();
    over_budget_ = scheduler.over_budget();
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (!over_budget_ && !scheduler.finished(static_cast<int>(k))) throw Interrupted{};
      if (scheduler.finished(static_cast<int>(k)))
        *places[k] = cell_end(scheduler.orbit(static_cast<int>(k)));
      else
        *places[k] = unmarched();
    }
    if (context_.checkpoints.keep && !over_budget_)
      for (const Batch* batch : marched) context_.checkpoints.keep(batch_key(batch->number), to_bytes(batch->ends));
    checkpoints.forget();
  }

  CellEnd unmarched() const {
    CellEnd end;
    end.status = Status::failed;
    end.reason = fmt::format("the budget of {:g} s was spent before", budget_of(case_));
    return end;
  }

  // One scene is enough to know what a batch that is read was marched with.
  void prepare_some(const std::vector<std::size_t>& batch) {
    for (const std::size_t cell : batch)
      if (scenes_.prepare(cell % columns_, cell / columns_).refusal.empty()) return describe_methods();
  }

  void describe_methods() {
    if (described_) return;
    described_ = true;
    section_ = section_plan(case_, scenes_.scenes());
    describe_march(record_, scenes_.scenes(), case_);
    record_.notes.push_back("a motion and its mirror image (x → −x, t → t + T/2) are one end");
  }

  void take(const std::vector<std::size_t>& batch, std::vector<CellEnd> ends) {
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const std::size_t cell = batch[i];
      refinement_.set_marched(cell);
      if (ends[i].motion.decided()) {
        SettledSection section = settled_section(ends[i], section_);
        if (one_scene_)
          end_of_[cell] = labels_.label(std::move(section));
        else
          sections_[cell] = std::move(section);
      }
      ends_[cell] = std::move(ends[i]);
      ends_[cell].displacements = {};  // the section was made of them
    }
  }

  // Whether two marched cells end alike. What is not decided is alike by its status.
  bool alike(std::size_t cell, std::size_t other) const {
    const CellEnd &a = ends_[cell], &b = ends_[other];
    if (!(a.motion == b.motion) || a.status != b.status || a.no_start != b.no_start) return false;
    if (!a.motion.decided()) return true;
    if (one_scene_) return end_of_[cell] == end_of_[other];
    return relative_distance(sections_.at(cell), sections_.at(other), kAlongParameter) <= 1;
  }

  // Of a case under way (not complete) only the cells that are known have a row.
  // Of a complete one the sections of the ends are given up on the way: those of millions of cells need not be there
  // twice.
  void write_tables(CaseRecord& record, bool complete) {
    const TableType<CellRow> type = cells_type();
    Table cells = type.head();
    NumberTable points = cell_points_type().head();
    const std::vector<std::size_t> sources = refinement_.sources();
    std::size_t count = 0;
    std::vector<std::size_t> last_use(sources.size());
    for (std::size_t cell = 0; cell < sources.size(); ++cell)
      if (const std::size_t source = sources[cell]; source < sources.size()) {
        count += ends_[source].section.size();
        last_use[source] = cell;
      }
    for (Series& column : points.values) column.own().reserve(count);
    cells.rows.reserve(sources.size());
    std::vector<std::size_t> row_of(sources.size());
    std::size_t rows = 0;
    for (std::size_t cell = 0; cell < sources.size(); ++cell)
      if (row_of[cell] = rows; complete || sources[cell] < sources.size()) ++rows;
    for (std::size_t cell = 0; cell < sources.size(); ++cell) {
      const double x = scenes_.axes()[0].values[cell % columns_], y = scenes_.axes()[1].values[cell / columns_];
      if (sources[cell] == sources.size()) {
        if (complete)
          cells.rows.push_back(type.rows.row(
              {"", x, y, word(Regime::failed), {}, {}, false, {}, word(Status::failed), unmarched().reason}));
        continue;
      }
      const CellEnd& end = ends_[sources[cell]];
      const int told = end_of_[sources[cell]];
      CellRow row{"", x, y, end.no_start ? no_start : word(end.motion.regime)};
      if (end.period > 0) row.period = end.period;
      if (told >= 0) row.attractor = told + 1;
      row.marched = sources[cell] == cell;
      row.source = row_of[sources[cell]];
      row.status = status_word(end);
      row.reason = end.reason;
      cells.rows.push_back(type.rows.row(row));
      for (std::size_t i = 0; i < end.section.size(); ++i) {
        const SectionPoint& point = end.section[i];
        points.add({static_cast<double>(row_of[cell]), static_cast<double>(i), point.displacement, point.velocity,
                    point.opposite_displacement, point.opposite_velocity});
      }
      if (complete && last_use[sources[cell]] == cell) ends_[sources[cell]].section = {};
    }
    record.tables.push_back(std::move(cells));
    record.numbers.push_back(std::move(points));
  }

  void show_partial() {
    if (!context_.checkpoints.show || ends_.size() > most_shown || !pace_.due()) return;
    CaseRecord partial = record_;
    write_tables(partial, false);
    partial.status = Status::done;
    std::size_t known = 0;
    for (std::size_t cell = 0; cell < ends_.size(); ++cell) known += refinement_.marched(cell);
    partial.reasons = {said("under way: {} cells marched", known)};
    pace_.take([&] { context_.checkpoints.show(partial); });
  }

  void finish() {
    write_tables(record_, true);
    std::size_t marched = 0, complete = 0, refused = 0, lost = 0, starts = ends_.size();
    const CellEnd *bad = nullptr, *beyond = nullptr;
    for (const std::size_t source : refinement_.sources())
      if (source < ends_.size() && ends_[source].no_start) {
        beyond = &ends_[source];
        --starts;
      }
    for (std::size_t cell = 0; cell < ends_.size(); ++cell) {
      if (!refinement_.marched(cell)) continue;
      const CellEnd& end = ends_[cell];
      if (end.no_start) continue;
      record_.steps += end.periods * section_.steps_per_period;
      refused += end.status == Status::refused;
      marched += end.status != Status::refused;
      complete += end.status == Status::done;
      lost += end.lost;
      if (end.status != Status::done && !bad) bad = &end;
    }
    put_measure(record_, "orbits", static_cast<double>(complete));
    if (beyond) put_measure(record_, "starts", static_cast<double>(starts));
    if (lost > 0) put_measure(record_, "orbits_lost", static_cast<double>(lost));
    if (lane_periods_ > 0)
      put_measure(record_, "lane_steps_per_second",
                  static_cast<double>(lane_periods_ * section_.steps_per_period) / std::max(1e-9, record_.run_seconds));
    if (refines(case_))
      record_.notes.push_back(fmt::format(
          "{} of {} cells were marched, {} filled from a marched one of their basin: only boundaries are refined",
          marched + refused, starts, starts - marched - refused));
    record_.status = complete > 0 ? Status::done : (marched == 0 ? Status::refused : Status::diverged);
    if (over_budget_) {
      record_.status = Status::failed;
      record_.reasons = {
          said("the budget of {:g} s was spent: {} of {} cells are known", budget_of(case_), complete, ends_.size())};
    } else if (complete == 0) {
      const CellEnd* why = bad ? bad : beyond;
      record_.reasons = {"no cell could be marched to its end" + (why ? "; " + why->reason : std::string())};
    } else if (bad) {
      record_.notes.push_back(fmt::format("{} of {} marched cells were refused or stopped; their rows say why",
                                          marched + refused - complete, marched + refused));
    }
  }

  const StudyCase& case_;
  const CaseContext& context_;
  const std::atomic<bool>& stop_;
  CellScenes scenes_;
  std::size_t columns_, rows_;
  GridRefinement refinement_;
  std::vector<CellEnd> ends_;  // of the marched cells
  SectionPlan section_;
  bool one_scene_ = true;                           // the axes are coordinates of its initial state
  OrbitEnds labels_;                                // of one scene
  std::vector<int> end_of_;                         // of the marched and decided cells, where the scene is one
  std::map<std::size_t, SettledSection> sections_;  // of the others, where it is not
  CaseRecord record_;
  long long lane_periods_ = 0;
  int batches_ = 0;
  bool described_ = false, over_budget_ = false;
  PartialPace pace_;
};

}  // namespace

CasePlan plan_basins(const StudyCase& study_case, const Registry& registry) {
  CasePlan out;
  CellScenes scenes(study_case, registry);
  const std::size_t columns = scenes.axes()[0].values.size(), rows = scenes.axes()[1].values.size();
  bool possible = false;
  std::pair<double, double> first_start;
  for (std::size_t cell = 0; cell < columns * rows && !possible; ++cell) {
    const CellScenes::Prepared prepared = scenes.prepare(cell % columns, cell / columns);
    possible = prepared.refusal.empty();
    first_start = {scenes.axes()[0].values[cell % columns], scenes.axes()[1].values[cell / columns]};
    if (!possible && out.refusal.empty())
      out.refusal = fmt::format("at ({:g}, {:g}): {}", scenes.axes()[0].values[cell % columns],
                                scenes.axes()[1].values[cell / columns], prepared.refusal);
  }
  if (!possible) return out;
  out.refusal.clear();
  describe_march(out, scenes.scenes(), study_case);
  const GridAxis &x = scenes.axes()[0], &y = scenes.axes()[1];
  for (const auto& [at_x, at_y] :
       {first_start, std::pair(x.values.front(), y.values.front()), {x.values.back(), y.values.back()}}) {
    try {
      widen_steps(out, with_parameters(study_case, {{x.pointer, at_x}, {y.pointer, at_y}}));
    } catch (const InputError&) {  // not marched in this corner
    }
  }
  const bool refine = refines(study_case);
  const std::size_t first = GridRefinement::first_cells(columns, rows, refine);
  const std::size_t cells = first + (columns * rows - first) / 4;
  if (refine)
    out.notes.push_back(
        fmt::format("{} of {} cells are marched, then those near boundaries; predicted as a quarter of the others",
                    first, columns * rows));
  const Json& settings = study_case.settings;
  const double periods = settings.at("transient").at("periods").get<double>() + settings.at("keep").get<double>();
  const double steps = periods * study_case.steps_per_period * static_cast<double>(cells);
  out.steps = static_cast<long long>(steps);
  out.predicted_seconds = steps * scenes.scenes().predicted_step_seconds(0, 8) / 8;
  // The last block of each round of refinement: blocks of the coarse grid are halved until nothing is between.
  const double rounds =
      refine ? 1 + std::log2(std::max(1.0, std::sqrt(static_cast<double>(columns * rows) / static_cast<double>(first))))
             : 1;
  out.chain_seconds = rounds * periods * study_case.steps_per_period * scenes.scenes().predicted_step_seconds(0, 8);
  // Measured: what is said of a cell, and its points on the section.
  constexpr double bytes_of_cell = 1000, bytes_of_point = 32;
  out.bytes = static_cast<double>(cells) * (bytes_of_cell + bytes_of_point * settings.at("keep").get<double>());
  return out;
}

CaseRecord run_basins(const StudyCase& study_case, const Registry& registry, const CaseContext& context,
                      const std::atomic<bool>& stop) {
  return BasinsRun(study_case, registry, context, stop).run();
}

}  // namespace ricochet
