#include <fmt/format.h>

#include <algorithm>
#include <ricochet/measure/attractors/basin_grid.hpp>
#include <set>

#include "runners/kinds/basins/basins.hpp"
#include "runners/kinds/sweep/diagram_tables.hpp"
#include "runners/kinds/sweep/with_parameter.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet::dynamics {
namespace {

/// A case shows an attractor where it has a quarter of the share that it has elsewhere.
constexpr double kShown = 0.25;
constexpr std::size_t kNoRow = static_cast<std::size_t>(-1);

/// A case with its table, as a grid.
struct Image {
  const CaseRecord* record = nullptr;
  const Table* table = nullptr;
  SectionIndex sections;
  std::vector<std::size_t> row_of;  ///< of each place, kNoRow where the case has no cell
  std::vector<int> periods;         ///< of each row, 0 where nothing repeats
};

/// What the grid of the study goes through.
GridOf grid_of(const StudyResults& results) {
  const auto axes = results.study.find("axes");
  if (axes == results.study.end() || !axes->is_array()) return GridOf::initial_states;
  const bool states = std::all_of(axes->begin(), axes->end(), [](const Json& axis) {
    return axis.is_object() && names_initial_state(axis.value("pointer", ""));
  });
  return states ? GridOf::initial_states : GridOf::parameters;
}

class BasinImages {
 public:
  explicit BasinImages(StudyResults& results) : results_(results), grid_of_(grid_of(results)) {
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

  void append_tables() const {
    for (Table table : {cells(), attractors(), fractions(), differences(), uncertainty()})
      results_.derived.push_back(std::move(table));
  }

 private:
  /// The grid is what the cases have rows for.
  void read_places() {
    std::set<double> xs, ys;
    for (const CaseRecord& record : results_.cases) {
      const Table* table = cells_.find(record.tables);
      if (!table) continue;
      images_.push_back({&record, table, SectionIndex::of_cells(record), {}, {}});
      cells_.rows.each(*table, [&](std::size_t, const CellRow& cell) {
        if (!cell.x || !cell.y) return;
        xs.insert(*cell.x);
        ys.insert(*cell.y);
      });
    }
    xs_.assign(xs.begin(), xs.end());
    ys_.assign(ys.begin(), ys.end());
    const auto index = [](const std::vector<double>& list, double value) {
      return static_cast<std::size_t>(std::lower_bound(list.begin(), list.end(), value) - list.begin());
    };
    for (Image& image : images_) {
      image.row_of.assign(xs_.size() * ys_.size(), kNoRow);
      image.periods.assign(image.table->rows.size(), 0);
      cells_.rows.each(*image.table, [&](std::size_t r, const CellRow& cell) {
        image.periods[r] = cell.period.value_or(0);
        if (cell.x && cell.y) image.row_of[index(ys_, *cell.y) * xs_.size() + index(xs_, *cell.x)] = r;
      });
    }
  }

  BasinGrid grid_from(const Image& image) const {
    BasinGrid grid;
    grid.columns = xs_.size();
    grid.rows = ys_.size();
    grid.cells.resize(image.row_of.size());
    std::vector<std::size_t> place_of(image.table->rows.size(), kNoRow);
    for (std::size_t place = 0; place < image.row_of.size(); ++place)
      if (image.row_of[place] != kNoRow) place_of[image.row_of[place]] = place;
    cells_.rows.each(*image.table, [&](std::size_t r, const CellRow& row) {
      if (place_of[r] == kNoRow) return;
      GridCell& cell = grid.cells[place_of[r]];
      cell.present = true;
      cell.motion = motion_of(row.regime, row.period, row.status.value_or("done"));
      // What the case itself has told apart while it marched.
      if (row.attractor && grid_of_ == GridOf::initial_states) cell.end = *row.attractor - 1;
    });
    return grid;
  }

  SettledSection section_at(const Image& image, std::size_t place, const MotionClass& motion) const {
    if (motion.regime == Regime::no_contact) return {motion, true, {}};
    const std::size_t row = image.row_of[place];
    const SectionReadings readings = image.sections.read(static_cast<double>(row), "");
    const int cycle = cycle_of(motion, image.periods[row]);
    return {motion, cycle > 0, make_cloud(readings.points, readings.opposite, scale_, cycle)};
  }

  Table cells() const {
    Table table = table_of_cases(results_, cells_.name, cells_.text, {});
    for (std::size_t c = 0; c < images_.size(); ++c) {
      const Image& image = images_[c];
      const std::size_t begin = table.rows.size();
      append_rows(results_, *image.record, *image.table, table);
      const auto column = find_column(table.columns, attractor_column.name);
      if (!column) continue;
      for (std::size_t place = 0; place < image.row_of.size(); ++place)
        if (const int attractor = grids_[c].cells[place].attractor; image.row_of[place] != kNoRow)
          table.rows[begin + image.row_of[place]][*column] = attractor >= 0 ? Cell(attractor + 1) : Cell();
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
                      text(attractors_[a].regime),
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

  Table fractions() const {
    const TableType<FractionRow> type = basin_fractions_type();
    Table table = table_of_cases(results_, type.head());
    for (std::size_t c = 0; c < grids_.size(); ++c) {
      const std::size_t decided = decided_cells(grids_[c]);
      if (decided == 0) continue;
      for (std::size_t a = 0; a < attractors_.size(); ++a) {
        const std::size_t count = count_cells(grids_[c], static_cast<int>(a));
        const Proportion share =
            wilson_interval(static_cast<double>(count) / static_cast<double>(decided), static_cast<double>(decided));
        const MotionClass& motion = attractors_[a];
        const FractionRow row{images_[c].record->id,
                              static_cast<int>(a) + 1,
                              text(motion.regime),
                              period_of(motion),
                              static_cast<int>(count),
                              share.value,
                              share.low,
                              share.high};
        add_row(table, place_of(results_, *images_[c].record), type.rows.row(row));
      }
    }
    return table;
  }

  Table differences() const {
    std::vector<BasinDifferenceRow> rows;
    for (std::size_t a = 0; a < grids_.size(); ++a)
      for (std::size_t b = a + 1; b < grids_.size(); ++b) {
        const auto [both, differ] = compare(grids_[a], grids_[b]);
        BasinDifferenceRow& row = rows.emplace_back();
        row = {images_[a].record->id, images_[b].record->id, both, differ, {}};
        if (both > 0) row.share = static_cast<double>(differ) / both;
      }
    return basin_differences_type().with(rows);
  }

  Table uncertainty() const {
    const TableType<UncertaintyRow> type = basin_uncertainty_type();
    Table table = table_of_cases(results_, type.head());
    for (std::size_t c = 0; c < grids_.size(); ++c) {
      const std::vector<int> labels = attractors_of(grids_[c]);
      const auto exponent =
          labels.empty() ? std::nullopt
                         : uncertainty_exponent(labels, static_cast<int>(xs_.size()), static_cast<int>(ys_.size()));
      UncertaintyRow row{images_[c].record->id, boundary_share(grids_[c]), {}, {}, {}};
      if (exponent) {
        row.exponent = exponent->value;
        row.low = exponent->low;
        row.high = exponent->high;
      }
      add_row(table, place_of(results_, *images_[c].record), type.rows.row(row));
    }
    return table;
  }

  StudyResults& results_;
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

void derive_basins(StudyResults& results) {
  const BasinImages images(results);
  if (!images.empty()) images.append_tables();
}

}  // namespace ricochet::dynamics
