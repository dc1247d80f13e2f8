#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ricochet/measure/attractors/basin_grid.hpp>
#include <set>

#include "runners/kinds/basins/basin_analysis.hpp"
#include "runners/kinds/basins/cell_scenes.hpp"
#include "runners/kinds/sweep/diagram_tables.hpp"
#include "runners/kinds/sweep/motion_asks.hpp"
#include "runners/kinds/sweep/page/orbits.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/rows_of_cases.hpp"

namespace ricochet::dynamics {
namespace {

/// A case shows an attractor where it has a quarter of the share that it has elsewhere.
constexpr double kShown = 0.25;
constexpr std::size_t kNoRow = static_cast<std::size_t>(-1);

/// A row of a case: where it leads, but for the attractor.
struct ReadCell {
  double x = NAN, y = NAN;
  std::size_t place = kNoRow;  ///< on the grid
  MotionClass motion;
  int period = 0, end = -1;  ///< period 0: nothing repeats; the end within the case, −1: not known
  std::uint8_t group = 0;    ///< of regime_groups; no_start_group of what begins beyond a stop
  bool done = true, filled = false;
};

/// A case with its table, as a grid.
struct Image {
  const CaseRecord* record = nullptr;
  const Table* table = nullptr;
  SectionIndex sections;
  std::vector<ReadCell> rows = {};
  std::map<std::string, std::size_t> reasons = {};  ///< of rows that failed
  std::vector<std::size_t> row_of = {};             ///< of each place, kNoRow where the case has no cell
};

using report::failed_group, report::regime_groups, report::undecided_group;
constexpr std::size_t no_start_group = regime_groups.size();

std::size_t group_of(const CellRow& cell) {
  if (cell.status == no_start) return no_start_group;
  if (of_word<Status>(cell.status.value_or("")).value_or(Status::done) != Status::done) return failed_group;
  return report::regime_group(cell.regime, cell.period);
}

ReadCell read_cell(const CellRow& row) {
  const std::string status = row.status.value_or(word(Status::done));
  return {.x = row.x.value_or(NAN),
          .y = row.y.value_or(NAN),
          .motion = dynamics::motion_of(row.regime, row.period, status),
          .period = row.period.value_or(0),
          .end = row.attractor.value_or(0) - 1,
          .group = static_cast<std::uint8_t>(group_of(row)),
          .done = of_word<Status>(status) == Status::done,
          .filled = !row.marched.value_or(true)};
}

/// What the grid of the study goes through.
GridOf grid_of(const StudyResults& results) {
  const auto axes = results.study.find("axes");
  if (axes == results.study.end() || !axes->is_array()) return GridOf::initial_states;
  const bool states = std::all_of(axes->begin(), axes->end(), [](const Json& axis) {
    return axis.is_object() && names_initial_state(axis.value("pointer", ""));
  });
  return states ? GridOf::initial_states : GridOf::parameters;
}

class BasinCases {
 public:
  explicit BasinCases(const StudyResults& results) : results_(results), grid_of_(grid_of(results)) {
    read_places();
    ScaleOfPoints scale;
    for (const Image& image : images_) image.sections.add_points(scale);
    scale_ = scale.scale();
    for (const Image& image : images_) {
      BasinGrid& grid = grids_.emplace_back(grid_from(image));
      const SectionOf section = [&](std::size_t place) { return section_at(image, place, grid.cells[place].motion); };
      grid_of_ == GridOf::initial_states ? find_ends(grid, section) : find_regions(grid, section);
    }
    attractors_ = match_attractors(grids_, grid_of_);
  }

  bool empty() const { return images_.empty(); }

  /// To be asked last: the grids go.
  BasinAnalysis analysis() {
    BasinAnalysis out;
    out.fractions = fractions();
    out.differences = differences();
    out.uncertainty = uncertainty();
    for (std::size_t c = 0; c < images_.size(); ++c) {
      BasinStarts& starts = out.starts[images_[c].record->id];
      for (const ReadCell& row : images_[c].rows) {
        ++starts.cells;
        starts.no_starts += row.group == no_start_group;
        if (row.done) ++(attractor_of(c, row) >= 0 ? starts.decided : starts.undecided);
      }
    }
    put_images(out);
    out.xs = std::move(xs_);
    out.ys = std::move(ys_);
    out.of_states = grid_of_ == GridOf::initial_states;
    for (const Image& image : images_) out.records.push_back(image.record);
    out.grids = std::move(grids_);
    return out;
  }

 private:
  /// The grid is what the cases have rows for.
  void read_places() {
    for (const CaseRecord& record : results_.cases) {
      const Table* table = cells_.find(record.tables);
      if (!table) continue;
      Image& image = images_.emplace_back(Image{&record, table, SectionIndex::of_cells(record)});
      image.rows.reserve(table->rows.size());
      cells_.rows.each(*table, [&](std::size_t, const CellRow& row) {
        ReadCell& cell = image.rows.emplace_back(read_cell(row));
        if (!row.x || !row.y) return;
        xs_.push_back(*row.x);
        ys_.push_back(*row.y);
        if (cell.group == failed_group) ++image.reasons[row.reason.value_or("")];
      });
      for (std::vector<double>* values : {&xs_, &ys_}) {
        std::sort(values->begin(), values->end());
        values->erase(std::unique(values->begin(), values->end()), values->end());
      }
    }
    const auto index = [](const std::vector<double>& list, double value) {
      return static_cast<std::size_t>(std::lower_bound(list.begin(), list.end(), value) - list.begin());
    };
    for (Image& image : images_) {
      image.row_of.assign(xs_.size() * ys_.size(), kNoRow);
      for (std::size_t r = 0; r < image.rows.size(); ++r)
        if (ReadCell& cell = image.rows[r]; !std::isnan(cell.x) && !std::isnan(cell.y)) {
          cell.place = index(ys_, cell.y) * xs_.size() + index(xs_, cell.x);
          image.row_of[cell.place] = r;
        }
    }
  }

  BasinGrid grid_from(const Image& image) const {
    BasinGrid grid;
    grid.columns = xs_.size();
    grid.rows = ys_.size();
    grid.cells.resize(image.row_of.size());
    for (const ReadCell& row : image.rows) {
      if (row.place == kNoRow) continue;
      GridCell& cell = grid.cells[row.place];
      cell.present = true;
      cell.motion = row.motion;
      // What the case itself has told apart while it marched.
      if (grid_of_ == GridOf::initial_states) cell.end = row.end;
    }
    return grid;
  }

  SettledSection section_at(const Image& image, std::size_t place, const MotionClass& motion) const {
    if (motion.regime == Regime::no_contact) return {motion, {}};
    const std::size_t row = image.row_of[place];
    const SectionReadings readings = image.sections.read(static_cast<double>(row), "");
    const int cycle = cycle_of(motion, image.rows[row].period);
    return {motion, make_cloud(readings.points, readings.opposite, scale_, cycle)};
  }

  /// Over all cases, from 0; −1: not decided.
  int attractor_of(std::size_t c, const ReadCell& row) const {
    return row.place == kNoRow ? -1 : grids_[c].cells[row.place].attractor;
  }

  /// Labels, and the label of each cell.
  void put_images(BasinAnalysis& out) const {
    constexpr std::size_t most_labels = 250;
    constexpr std::array attractor_colours = {"#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00",
                                              "#6A3D9A", "#8C6D31", "#F0E442", "#44AA99", "#882255", "#999933"};
    constexpr const char* no_start_colour = "#E4DFD2";
    // By attractor, then by group.
    const auto rank_of = [&](std::size_t c, const ReadCell& row) {
      const int attractor = attractor_of(c, row);
      return attractor >= 0 ? static_cast<std::size_t>(attractor) : attractors_.size() + row.group;
    };
    std::vector<char> met(attractors_.size() + no_start_group + 1, 0);
    for (std::size_t c = 0; c < images_.size(); ++c)
      for (const ReadCell& row : images_[c].rows)
        if (row.place != kNoRow) met[rank_of(c, row)] = 1;
    std::vector<std::uint8_t> label_of(met.size(), 0);
    for (std::size_t rank = 0; rank < met.size(); ++rank) {
      if (!met[rank]) continue;
      // Those beyond the most share the last one.
      label_of[rank] = static_cast<std::uint8_t>(std::min(out.labels.size(), most_labels - 1));
      if (out.labels.size() == most_labels) continue;
      if (rank < attractors_.size()) {
        const std::string text = regime_text(word(attractors_[rank].regime), period_of(attractors_[rank]));
        const char* colour = attractor_colours[out.labels.size() % attractor_colours.size()];
        out.labels.push_back({fmt::format("attractor {}{}", rank + 1, text.empty() ? "" : " (" + text + ")"), colour});
      } else if (const std::size_t group = rank - attractors_.size(); group == no_start_group) {
        out.labels.push_back({no_start, no_start_colour, false, false});
      } else {
        // Without attractors groups such as "period 3" tell the cells apart.
        out.labels.push_back({regime_groups[group].name, regime_groups[group].colour, group < undecided_group});
      }
    }
    for (std::size_t c = 0; c < images_.size(); ++c) {
      report::BasinImage image{images_[c].record};
      image.cells.assign(grids_[c].cells.size(), report::BasinImage::absent);
      image.reasons = images_[c].reasons;
      for (const ReadCell& row : images_[c].rows) {
        if (row.place == kNoRow) continue;
        const bool started = row.group != no_start_group, failed = row.group == failed_group;
        image.cells[row.place] = label_of[rank_of(c, row)];
        image.no_starts += !started;
        image.filled += row.filled && started && !failed;
      }
      if (!images_[c].rows.empty()) out.images.push_back(std::move(image));
    }
  }

 public:
  Table cells() const {
    Table table = table_of_cases(results_, cells_.name, cells_.text, {});
    for (std::size_t c = 0; c < images_.size(); ++c) {
      const Image& image = images_[c];
      const std::size_t begin = table.rows.size();
      append_rows(results_, *image.record, *image.table, table);
      const auto column = find_column(table.columns, attractor_column.name);
      if (!column) continue;
      for (std::size_t r = 0; r < image.rows.size(); ++r)
        if (image.rows[r].place != kNoRow) {
          const int attractor = attractor_of(c, image.rows[r]);
          table.rows[begin + r][*column] = attractor >= 0 ? Cell(attractor + 1) : Cell();
        }
    }
    return table;
  }

  Table attractors() const {
    std::vector<AttractorRow> rows;
    std::vector<const CaseRecord*> records;
    for (const Image& image : images_) records.push_back(image.record);
    const std::vector<ChoiceAxis> axes = axes_of(results_, records);
    for (std::size_t a = 0; a < attractors_.size(); ++a) {
      std::vector<double> shares;
      Presence presence;
      std::size_t cases = 0, grid = 0;
      double sum = 0;
      for (std::size_t c = 0; c < grids_.size(); ++c) {
        const std::size_t decided = decided_cells(grids_[c]);
        if (decided == 0) continue;
        const std::size_t count = count_cells(grids_[c], static_cast<int>(a));
        presence.cases.push_back(c);
        shares.push_back(static_cast<double>(count) / static_cast<double>(decided));
        cases += count > 0;
        // Methods repeat one grid: its cells count once in the interval.
        if (count > 0) {
          sum += shares.back();
          grid = std::max(grid, decided);
        }
      }
      const double largest = *std::max_element(shares.begin(), shares.end());
      for (const double share : shares) presence.present.push_back(share > 0 && share >= kShown * largest);
      const PresenceLabel label = label_presence(presence, axes);
      const Proportion fraction = wilson_interval(sum / static_cast<double>(cases), static_cast<double>(grid));
      rows.push_back({static_cast<int>(a) + 1,
                      label.label,
                      static_cast<int>(cases),
                      {},
                      {},
                      word(attractors_[a].regime),
                      period_of(attractors_[a]),
                      {},
                      fraction.value,
                      fraction.low,
                      fraction.high,
                      label.presence,
                      fmt::format("Attractor {} ({}, {} of the cells where it shows) {}", a + 1, text(attractors_[a]),
                                  percent(fraction.value), label.sentence)});
    }
    return attractors_type(swept_).with(rows);
  }

 private:
  std::vector<FractionRow> fractions() const {
    std::vector<FractionRow> rows;
    for (std::size_t c = 0; c < grids_.size(); ++c) {
      const std::size_t decided = decided_cells(grids_[c]);
      if (decided == 0) continue;
      for (std::size_t a = 0; a < attractors_.size(); ++a) {
        const std::size_t count = count_cells(grids_[c], static_cast<int>(a));
        const Proportion share =
            wilson_interval(static_cast<double>(count) / static_cast<double>(decided), static_cast<double>(decided));
        const MotionClass& motion = attractors_[a];
        rows.push_back({images_[c].record->id, static_cast<int>(a) + 1, word(motion.regime), period_of(motion),
                        static_cast<int>(count), share.value, share.low, share.high});
      }
    }
    return rows;
  }

  std::vector<BasinDifferenceRow> differences() const {
    std::vector<BasinDifferenceRow> rows;
    for (std::size_t a = 0; a < grids_.size(); ++a)
      for (std::size_t b = a + 1; b < grids_.size(); ++b) {
        const auto [both, differ] = compare(grids_[a], grids_[b]);
        BasinDifferenceRow& row = rows.emplace_back();
        row = {images_[a].record->id,
               images_[b].record->id,
               both,
               differ,
               static_cast<int>(compare_motions(grids_[a].cells, grids_[b].cells).changed),
               {}};
        if (both > 0) row.share = static_cast<double>(differ) / both;
      }
    return rows;
  }

  std::vector<UncertaintyRow> uncertainty() const {
    std::vector<UncertaintyRow> rows;
    for (std::size_t c = 0; c < grids_.size(); ++c) {
      const std::vector<int> labels = attractors_of(grids_[c]);
      const auto exponent =
          labels.empty() ? std::nullopt
                         : uncertainty_exponent(labels, static_cast<int>(xs_.size()), static_cast<int>(ys_.size()));
      UncertaintyRow& row = rows.emplace_back();
      row.id = images_[c].record->id;
      row.boundary_share = boundary_share(grids_[c]);
      if (exponent) {
        row.exponent = exponent->value;
        row.low = exponent->low;
        row.high = exponent->high;
      }
    }
    return rows;
  }

  const StudyResults& results_;
  const SweptColumns swept_ = swept_columns(results_);
  const TableType<CellRow> cells_ = cells_type(swept_);
  GridOf grid_of_;
  std::vector<double> xs_, ys_;
  CloudPoint scale_ = {1, 1};
  std::vector<Image> images_;
  std::vector<BasinGrid> grids_;  // of the images
  std::vector<MotionClass> attractors_;
};

}  // namespace
}  // namespace ricochet::dynamics

namespace ricochet {

BasinAnalysis analyse_basins(StudyResults& results) {
  dynamics::BasinCases cases(results);
  if (cases.empty()) return {};
  results.derived.push_back(cases.cells());
  results.derived.push_back(cases.attractors());
  BasinAnalysis out = cases.analysis();
  results.derived.push_back(rows_of_cases(results, basin_fractions_type(), out.fractions));
  results.derived.push_back(basin_differences_type().with(out.differences));
  results.derived.push_back(rows_of_cases(results, basin_uncertainty_type(), out.uncertainty));
  return out;
}

}  // namespace ricochet
