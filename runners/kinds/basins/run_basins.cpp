#include "runners/kinds/basins/run_basins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ricochet/measure/attractors/branches.hpp>
#include <ricochet/measure/attractors/grid_refinement.hpp>
#include <ricochet/measure/attractors/orbit_ends.hpp>

#include "runners/kinds/basins/cell_ends.hpp"
#include "runners/kinds/basins/cell_scenes.hpp"
#include "runners/kinds/sweep/orbit_checkpoints.hpp"
#include "runners/kinds/sweep/sweep_tables.hpp"
#include "runners/march/partial_pace.hpp"
#include "runners/march/prepare_case.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet {
namespace {

constexpr std::size_t largest_batch = 4096;  // cells whose orbits are in memory at one time
constexpr std::size_t most_shown = 200000;   // of more cells nothing is shown on the way: it would be in memory twice

bool refines(const StudyCase& study_case) {
  const Json& wanted = study_case.settings.at("refine");
  return wanted.is_boolean() && wanted.get<bool>();
}

class BasinsRun {
 public:
  BasinsRun(const StudyCase& study_case, const Registry& registry, const CaseDesk& desk, const std::atomic<bool>& stop)
      : case_(study_case),
        desk_(desk),
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
      for (std::size_t first = 0; first < wanted.size() && !over_budget_; first += largest_batch) {
        const auto begin = wanted.begin() + static_cast<std::ptrdiff_t>(first);
        const std::vector<std::size_t> batch(
            begin, begin + static_cast<std::ptrdiff_t>(std::min(largest_batch, wanted.size() - first)));
        take(batch, march(batch));
      }
    finish();
    for (int batch = 0; desk_.shelf.keep && batch < batches_; ++batch) desk_.shelf.keep(batch_key(batch), "");
    return std::move(record_);
  }

 private:
  std::string batch_key(int batch) const { return fmt::format("cells/{}/{}", desk_.key, batch); }

  // The ends of a batch of cells; batches that an interrupted run had finished are read.
  std::vector<CellEnd> march(const std::vector<std::size_t>& batch) {
    const int number = batches_++;
    if (auto known = recall(desk_.shelf, batch_key(number), cell_ends); known && known->size() == batch.size()) {
      if (scenes_.scenes().groups() == 0) prepare_some(batch);
      return std::move(*known);
    }
    const double begun = thread_seconds();
    scenes_.begin();
    std::vector<CellEnd> ends(batch.size());
    std::vector<std::size_t> places;  // of the tasks
    std::vector<OrbitTask> tasks;
    for (std::size_t i = 0; i < batch.size(); ++i) {
      CellScenes::Prepared cell = scenes_.prepare(batch[i] % columns_, batch[i] / columns_);
      if (cell.refusal.empty()) {
        places.push_back(i);
        tasks.push_back(std::move(cell.task));
      } else {
        ends[i] = refused_end(cell.refusal);
      }
    }
    record_.setup_seconds += thread_seconds() - begun;
    if (tasks.empty()) return ends;
    describe_methods();
    OrbitScheduler scheduler(scenes_.scenes(), {.section = section_,
                                                .seats = desk_.seats,
                                                .budget = budget_of(case_) - record_.run_seconds,
                                                .lean = true,
                                                .blocks = desk_.blocks,
                                                .case_id = case_.id});
    for (OrbitTask& task : tasks) scheduler.add(std::move(task));
    OrbitCheckpoints checkpoints(desk_.shelf, fmt::format("{}/{}", desk_.key, number));
    scheduler.restore(checkpoints.find());
    scheduler.run(stop_, [&](const MarchedOrbits& marched) {
      checkpoints.save(marched);
      show_partial();
    });
    record_.run_seconds += scheduler.seconds();
    lane_periods_ += scheduler.lane_periods();
    over_budget_ = scheduler.over_budget();
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (!over_budget_ && !scheduler.finished(static_cast<int>(k))) throw Interrupted{};
      if (scheduler.finished(static_cast<int>(k)))
        ends[places[k]] = cell_end(scheduler.orbit(static_cast<int>(k)), section_);
      else
        ends[places[k]] = unmarched();
    }
    if (desk_.shelf.keep && !over_budget_) desk_.shelf.keep(batch_key(number), to_bytes(ends));
    checkpoints.forget();
    return ends;
  }

  CellEnd unmarched() const {
    CellEnd end;
    end.status = "failed";
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
    }
  }

  // Whether two marched cells end alike. What is not decided is alike by its status.
  bool alike(std::size_t cell, std::size_t other) const {
    const CellEnd &a = ends_[cell], &b = ends_[other];
    if (!(a.motion == b.motion) || a.status != b.status) return false;
    if (!a.motion.decided()) return true;
    if (one_scene_) return end_of_[cell] == end_of_[other];
    return relative_distance(sections_.at(cell), sections_.at(other), kAlongParameter) <= 1;
  }

  // Of a case under way (not complete) only the cells that are known have a row.
  void write_tables(CaseRecord& record, bool complete) const {
    Table cells = cells_head();
    NumberTable points = cell_points_head();
    const std::vector<std::size_t> sources = refinement_.sources();
    std::vector<std::size_t> row_of(sources.size());
    std::size_t rows = 0;
    for (std::size_t cell = 0; cell < sources.size(); ++cell)
      if (row_of[cell] = rows; complete || sources[cell] < sources.size()) ++rows;
    for (std::size_t cell = 0; cell < sources.size(); ++cell) {
      const double x = scenes_.axes()[0].values[cell % columns_], y = scenes_.axes()[1].values[cell / columns_];
      if (sources[cell] == sources.size()) {
        if (complete)
          cells.rows.push_back(
              {x, y, text(Regime::failed), nullptr, nullptr, false, nullptr, "failed", unmarched().reason});
        continue;
      }
      const CellEnd& end = ends_[sources[cell]];
      const int told = end_of_[sources[cell]];
      cells.rows.push_back({x, y, text(end.motion.regime), end.period > 0 ? Cell(end.period) : Cell(),
                            told >= 0 ? Cell(told + 1) : Cell(), sources[cell] == cell, row_of[sources[cell]],
                            end.status, end.reason});
      for (std::size_t i = 0; i < end.section.size(); ++i) {
        const SectionPoint& point = end.section[i];
        points.add({static_cast<double>(row_of[cell]), static_cast<double>(i), point.displacement, point.velocity,
                    point.opposite_displacement, point.opposite_velocity});
      }
    }
    record.tables.push_back(std::move(cells));
    record.numbers.push_back(std::move(points));
  }

  void show_partial() {
    if (!desk_.shelf.show || ends_.size() > most_shown || !pace_.due()) return;
    CaseRecord partial = record_;
    write_tables(partial, false);
    partial.status = "done";
    std::size_t known = 0;
    for (std::size_t cell = 0; cell < ends_.size(); ++cell) known += refinement_.marched(cell);
    partial.reason = fmt::format("under way: {} cells marched", known);
    pace_.take([&] { desk_.shelf.show(partial); });
  }

  void finish() {
    write_tables(record_, true);
    std::size_t marched = 0, complete = 0, refused = 0, lost = 0;
    const CellEnd* bad = nullptr;
    for (std::size_t cell = 0; cell < ends_.size(); ++cell) {
      if (!refinement_.marched(cell)) continue;
      const CellEnd& end = ends_[cell];
      record_.steps += end.periods * section_.steps_per_period;
      refused += end.status == "refused";
      marched += end.status != "refused";
      complete += end.status == "done";
      lost += end.lost;
      if (end.status != "done" && !bad) bad = &end;
    }
    put_measure(record_, "orbits", static_cast<double>(complete));
    if (lost > 0) put_measure(record_, "orbits_lost", static_cast<double>(lost));
    if (lane_periods_ > 0)
      put_measure(record_, "lane_steps_per_second",
                  static_cast<double>(lane_periods_ * section_.steps_per_period) / std::max(1e-9, record_.run_seconds));
    if (refines(case_))
      record_.notes.push_back(fmt::format(
          "{} of {} cells were marched, {} filled from a marched one of their basin: only boundaries are refined",
          marched + refused, ends_.size(), ends_.size() - marched - refused));
    record_.status = complete > 0 ? "done" : (marched == 0 ? "refused" : "diverged");
    if (over_budget_) {
      record_.status = "failed";
      record_.reason = fmt::format("the budget of {:g} s was spent: {} of {} cells are known", budget_of(case_),
                                   complete, ends_.size());
    } else if (complete == 0) {
      record_.reason = "no cell could be marched to its end" + (bad ? "; " + bad->reason : std::string());
    } else if (bad) {
      record_.notes.push_back(fmt::format("{} of {} marched cells were refused or stopped; their rows say why",
                                          marched + refused - complete, marched + refused));
    }
  }

  const StudyCase& case_;
  const CaseDesk& desk_;
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
  for (std::size_t cell = 0; cell < columns * rows && !possible; ++cell) {
    const CellScenes::Prepared prepared = scenes.prepare(cell % columns, cell / columns);
    possible = prepared.refusal.empty();
    if (!possible && out.refusal.empty())
      out.refusal = fmt::format("at ({:g}, {:g}): {}", scenes.axes()[0].values[cell % columns],
                                scenes.axes()[1].values[cell / columns], prepared.refusal);
  }
  if (!possible) return out;
  out.refusal.clear();
  describe_march(out, scenes.scenes(), study_case);
  const GridAxis &x = scenes.axes()[0], &y = scenes.axes()[1];
  for (const auto& [at_x, at_y] : {std::pair(x.values.front(), y.values.front()), {x.values.back(), y.values.back()}}) {
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
        fmt::format("{} of {} cells are marched, then those near boundaries; predicted as a quarter of "
                    "the others",
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

CaseRecord run_basins(const StudyCase& study_case, const Registry& registry, const CaseDesk& desk,
                      const std::atomic<bool>& stop) {
  return BasinsRun(study_case, registry, desk, stop).run();
}

}  // namespace ricochet
