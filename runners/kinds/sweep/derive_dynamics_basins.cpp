#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <numeric>
#include <ricochet/measure/attractors/branches.hpp>
#include <ricochet/measure/attractors/uncertainty_exponent.hpp>
#include <set>

#include "runners/kinds/sweep/derive_dynamics_parts.hpp"
#include "runners/store/record_values.hpp"

namespace ricochet::dynamics {
namespace {

/// Cells of one case: shorter transients than a diagram's leave more behind.
constexpr LinkRule kSameCase{0.05, 2};
/// A case shows an attractor where it has a quarter of the share that it has elsewhere.
constexpr double kShown = 0.25;

/// One cell of a case.
struct GridCell {
  std::size_t row = 0;
  int kind = -1, period = 0;
  int label = -1;      ///< within the case
  int attractor = -1;  ///< over all cases, from 0
};

/// A case on the grid of the study, row after row; −1 where it has no cell.
struct Image {
  const CaseRecord* record = nullptr;
  const Table* table = nullptr;
  SectionIndex sections;
  std::vector<GridCell> cells;
  std::vector<int> at;
  int labels = 0;
};

class BasinImages {
 public:
  explicit BasinImages(StudyResults& results) : results_(results) {
    read();
    number_places();
    initial_states_ = on_initial_states();
    for (Image& image : images_) initial_states_ ? label_by_leaders(image) : label_by_regions(image);
    initial_states_ ? match_leaders() : match_regions();
    sort_attractors();
  }

  bool empty() const { return images_.empty(); }

  void append_tables() const {
    for (Table table : {cells(), attractors(), fractions(), differences(), uncertainty()})
      results_.derived.push_back(std::move(table));
  }

 private:
  void read() {
    ScaleOfPoints scale;
    std::set<double> xs, ys;
    for (const CaseRecord& record : results_.cases) {
      const Table* table = find_table(record.tables, "cells");
      if (!table) continue;
      images_.push_back({&record, table, SectionIndex(record, "cell_points", "cell", ""), {}, {}, 0});
      Image& image = images_.back();
      const TableReader rows(*table);
      const std::size_t x = rows.column("x"), y = rows.column("y"), regime = rows.column("class"),
                        period = rows.column("period"), status = rows.column_if_any("status");
      for (std::size_t r = 0; r < rows.size(); ++r) {
        const auto across = rows.number(r, x), along = rows.number(r, y);
        if (!across || !along) continue;
        xs.insert(*across);
        ys.insert(*along);
        GridCell cell;
        cell.row = r;
        cell.period = static_cast<int>(rows.number(r, period).value_or(0));
        cell.kind =
            kind_of(rows.text(r, regime), status == TableReader::absent ? "done" : rows.text(r, status), cell.period);
        image.cells.push_back(cell);
      }
      for (const char* name : {"tip", "opposite"}) {
        const bool mirrored = name[0] == 'o';
        const auto *d = image.sections.column(std::string(name) + "_displacement"),
                   *v = image.sections.column(std::string(name) + "_velocity");
        if (!d || !v) continue;
        for (std::size_t k = 0; k < d->size(); ++k)
          scale.add(mirrored ? CloudPoint{-(*d)[k], -(*v)[k]} : CloudPoint{(*d)[k], (*v)[k]});
      }
    }
    xs_.assign(xs.begin(), xs.end());
    ys_.assign(ys.begin(), ys.end());
    scale_ = scale.scale();
  }

  void number_places() {
    for (Image& image : images_) {
      image.at.assign(xs_.size() * ys_.size(), -1);
      const TableReader rows(*image.table);
      const std::size_t x = rows.column("x"), y = rows.column("y");
      for (std::size_t k = 0; k < image.cells.size(); ++k) {
        const auto place = [&](const std::vector<double>& list, std::size_t column) {
          const double value = *rows.number(image.cells[k].row, column);
          return static_cast<std::size_t>(std::lower_bound(list.begin(), list.end(), value) - list.begin());
        };
        image.at[place(ys_, y) * xs_.size() + place(xs_, x)] = static_cast<int>(k);
      }
    }
  }

  int kind_of(const std::string& regime, const std::string& status, int period) {
    if (status == "failed" || status == "refused" || status == "diverged") return -1;
    std::string kind = regime;
    if (regime == "periodic")
      kind += " " + std::to_string(period);
    else if (regime != "no contact" && regime != "quasi-periodic" && regime != "chaotic")
      return -1;
    const auto found = std::find(kinds_.begin(), kinds_.end(), kind);
    if (found == kinds_.end()) kinds_.push_back(kind);
    return static_cast<int>(std::find(kinds_.begin(), kinds_.end(), kind) - kinds_.begin());
  }

  /// Two coordinates of the initial state: the attractors are the same everywhere. Else they move with the parameters.
  bool on_initial_states() const {
    const auto axes = results_.study.find("axes");
    if (axes == results_.study.end() || !axes->is_array()) return true;
    return std::all_of(axes->begin(), axes->end(), [](const Json& axis) {
      return axis.is_object() && axis.value("pointer", "").starts_with("/scene/initial");
    });
  }

  SettledSection section(const Image& image, const GridCell& cell) const {
    const std::string& kind = kinds_[static_cast<std::size_t>(cell.kind)];
    // A motion without contact is the linear response, told by its kind.
    if (kind == "no contact") return {cell.kind, true, {}};
    const SectionReadings readings = image.sections.read(static_cast<double>(cell.row), "");
    const int cycle = kind.starts_with("periodic") ? std::max(cell.period, 1) : 0;
    return {cell.kind, cycle > 0, make_cloud(readings.points, readings.opposite, scale_, cycle)};
  }

  /// Each cell goes to the nearest of the sections met before, or leads the way for those to come.
  void label_by_leaders(Image& image) {
    std::vector<SettledSection>& leaders = leaders_.emplace_back();
    for (GridCell& cell : image.cells) {
      if (cell.kind < 0) continue;
      SettledSection own = section(image, cell);
      if (own.cloud.empty() && kinds_[static_cast<std::size_t>(cell.kind)] != "no contact") continue;
      double nearest = 1;
      for (std::size_t k = 0; k < leaders.size(); ++k)
        if (const double distance = relative_distance(leaders[k], own, kSameCase); distance <= nearest) {
          nearest = distance;
          cell.label = static_cast<int>(k);
        }
      if (cell.label >= 0) continue;
      cell.label = static_cast<int>(leaders.size());
      leaders.push_back(std::move(own));
    }
    image.labels = static_cast<int>(leaders.size());
    fill_by_neighbours(image, leaders);
  }

  /// Cells whose class is known and whose section is not (they lie inside a region) take the label of the nearest cells
  /// of their class.
  void fill_by_neighbours(Image& image, std::vector<SettledSection>& leaders) const {
    std::deque<std::size_t> front;
    for (std::size_t place = 0; place < image.at.size(); ++place)
      if (image.at[place] >= 0 && image.cells[static_cast<std::size_t>(image.at[place])].label >= 0)
        front.push_back(place);
    const auto flood = [&] {
      for (; !front.empty(); front.pop_front()) {
        const GridCell from = image.cells[static_cast<std::size_t>(image.at[front.front()])];
        for (const std::size_t place : neighbours(front.front())) {
          if (image.at[place] < 0) continue;
          GridCell& cell = image.cells[static_cast<std::size_t>(image.at[place])];
          if (cell.label >= 0 || cell.kind != from.kind) continue;
          cell.label = from.label;
          front.push_back(place);
        }
      }
    };
    flood();
    for (std::size_t place = 0; place < image.at.size(); ++place) {
      if (image.at[place] < 0) continue;
      GridCell& cell = image.cells[static_cast<std::size_t>(image.at[place])];
      if (cell.label >= 0 || cell.kind < 0) continue;
      const auto same = std::find_if(leaders.begin(), leaders.end(),
                                     [&](const SettledSection& leader) { return leader.kind == cell.kind; });
      cell.label = static_cast<int>(same - leaders.begin());
      if (same == leaders.end()) leaders.push_back({cell.kind, true, {}});
      image.labels = static_cast<int>(leaders.size());
      front.push_back(place);
      flood();
    }
  }

  std::vector<std::size_t> neighbours(std::size_t place) const {
    const std::size_t columns = xs_.size(), x = place % columns, y = place / columns;
    std::vector<std::size_t> out;
    if (x > 0) out.push_back(place - 1);
    if (x + 1 < columns) out.push_back(place + 1);
    if (y > 0) out.push_back(place - columns);
    if (y + 1 < ys_.size()) out.push_back(place + columns);
    return out;
  }

  /// Neighbouring cells of one class whose sections are near belong together.
  void label_by_regions(Image& image) {
    const std::size_t columns = xs_.size();
    std::vector<std::size_t> parent(image.at.size());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::size_t k) {
      while (parent[k] != k) k = parent[k] = parent[parent[k]];
      return k;
    };
    std::vector<SettledSection> above(columns), here(columns);
    for (std::size_t place = 0; place < image.at.size(); ++place) {
      const std::size_t x = place % columns;
      if (x == 0) std::swap(above, here);
      here[x] = {-1, false, {}};
      if (image.at[place] < 0) continue;
      const GridCell& cell = image.cells[static_cast<std::size_t>(image.at[place])];
      if (cell.kind < 0) continue;
      here[x] = section(image, cell);
      if (x > 0 && relative_distance(here[x - 1], here[x], kAlongParameter) <= 1) parent[root(place)] = root(place - 1);
      if (place >= columns && relative_distance(above[x], here[x], kAlongParameter) <= 1)
        parent[root(place)] = root(place - columns);
    }
    std::map<std::size_t, int> known;
    for (std::size_t place = 0; place < image.at.size(); ++place) {
      if (image.at[place] < 0) continue;
      GridCell& cell = image.cells[static_cast<std::size_t>(image.at[place])];
      if (cell.kind >= 0) cell.label = known.emplace(root(place), static_cast<int>(known.size())).first->second;
    }
    image.labels = static_cast<int>(known.size());
  }

  void match_leaders() {
    std::vector<OwnedSection> sections;
    for (std::size_t c = 0; c < images_.size(); ++c)
      for (const SettledSection& leader : leaders_[c]) sections.push_back({static_cast<int>(c), &leader});
    const std::vector<int> groups = match_owners(sections);
    std::size_t first = 0;
    for (std::size_t c = 0; c < images_.size(); ++c) {
      for (GridCell& cell : images_[c].cells)
        if (cell.label >= 0) cell.attractor = groups[first + static_cast<std::size_t>(cell.label)];
      first += leaders_[c].size();
    }
    for (const int group : groups) attractors_ = std::max(attractors_, group + 1);
  }

  /// A region is the one of an earlier case that it shares most cells with.
  void match_regions() {
    for (std::size_t c = 0; c < images_.size(); ++c) {
      Image& image = images_[c];
      std::map<std::pair<int, int>, int> shared;  // label, attractor → cells
      for (std::size_t before = 0; before < c; ++before)
        for (std::size_t place = 0; place < image.at.size(); ++place) {
          if (image.at[place] < 0 || images_[before].at[place] < 0) continue;
          const GridCell &one = image.cells[static_cast<std::size_t>(image.at[place])],
                         &other = images_[before].cells[static_cast<std::size_t>(images_[before].at[place])];
          if (one.label >= 0 && one.kind == other.kind) ++shared[{one.label, other.attractor}];
        }
      std::vector<std::pair<int, std::pair<int, int>>> most;
      for (const auto& [pair, count] : shared) most.emplace_back(-count, pair);
      std::sort(most.begin(), most.end());
      std::vector<int> attractor(static_cast<std::size_t>(image.labels), -1);
      std::set<int> taken;
      for (const auto& [count, pair] : most)
        if (attractor[static_cast<std::size_t>(pair.first)] < 0 && taken.insert(pair.second).second)
          attractor[static_cast<std::size_t>(pair.first)] = pair.second;
      for (int& one : attractor)
        if (one < 0) one = attractors_++;
      for (GridCell& cell : image.cells)
        if (cell.label >= 0) cell.attractor = attractor[static_cast<std::size_t>(cell.label)];
    }
  }

  /// Numbers from the largest basin on.
  void sort_attractors() {
    std::vector<int> size(static_cast<std::size_t>(attractors_), 0), order(size.size()), place(size.size());
    for (const Image& image : images_)
      for (const GridCell& cell : image.cells)
        if (cell.attractor >= 0) ++size[static_cast<std::size_t>(cell.attractor)];
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return size[static_cast<std::size_t>(a)] > size[static_cast<std::size_t>(b)];
    });
    for (std::size_t k = 0; k < order.size(); ++k) place[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
    kind_of_attractor_.assign(size.size(), -1);
    for (Image& image : images_)
      for (GridCell& cell : image.cells)
        if (cell.attractor >= 0) {
          cell.attractor = place[static_cast<std::size_t>(cell.attractor)];
          kind_of_attractor_[static_cast<std::size_t>(cell.attractor)] = cell.kind;
        }
    while (!kind_of_attractor_.empty() && kind_of_attractor_.back() < 0) kind_of_attractor_.pop_back();
  }

  std::size_t count_in(const Image& image, int attractor) const {
    return static_cast<std::size_t>(std::count_if(image.cells.begin(), image.cells.end(),
                                                  [&](const GridCell& cell) { return cell.attractor == attractor; }));
  }
  std::size_t decided_in(const Image& image) const { return image.cells.size() - count_in(image, -1); }

  const std::string& kind_name(std::size_t attractor) const {
    return kinds_[static_cast<std::size_t>(kind_of_attractor_[attractor])];
  }
  /// Class and period of an attractor.
  std::pair<std::string, Cell> class_of(std::size_t attractor) const {
    const std::string& kind = kind_name(attractor);
    if (kind.starts_with("periodic ")) return {"periodic", Cell(std::stoi(kind.substr(9)))};
    return {kind, Cell()};
  }

  Table cells() const {
    const Table head = cells_head(swept_);
    Table table = table_of_cases(results_, head.name, head.text, {});
    for (const Image& image : images_) {
      const std::size_t begin = table.rows.size();
      append_rows(results_, *image.record, *image.table, table);
      const auto column = find_column(table.columns, "attractor");
      if (!column) continue;
      for (const GridCell& cell : image.cells)
        if (cell.attractor >= 0) table.rows[begin + cell.row][*column] = cell.attractor + 1;
    }
    return table;
  }

  Table attractors() const {
    Table table = attractors_head(swept_);
    std::vector<const CaseRecord*> records;
    for (const Image& image : images_) records.push_back(image.record);
    const std::vector<ChoiceAxis> axes = axes_of(results_, records);
    for (std::size_t a = 0; a < kind_of_attractor_.size(); ++a) {
      std::vector<double> shares;
      Presence presence;
      std::size_t cases = 0, grid = 0;
      double sum = 0;
      for (std::size_t c = 0; c < images_.size(); ++c) {
        const std::size_t decided = decided_in(images_[c]);
        if (decided == 0) continue;
        const std::size_t count = count_in(images_[c], static_cast<int>(a));
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
      const auto [regime, period] = class_of(a);
      table.rows.push_back({a + 1, label.label, cases, nullptr, nullptr, regime, period, nullptr, fraction.value,
                            fraction.low, fraction.high, label.presence,
                            fmt::format("Attractor {} ({}, {} of the cells where it shows) {}", a + 1, kind_name(a),
                                        percent(fraction.value), label.sentence)});
    }
    return table;
  }

  Table fractions() const {
    Table table = table_of_cases(results_, basin_fractions_head());
    for (const Image& image : images_) {
      const std::size_t decided = decided_in(image);
      if (decided == 0) continue;
      for (std::size_t a = 0; a < kind_of_attractor_.size(); ++a) {
        const std::size_t count = count_in(image, static_cast<int>(a));
        const Proportion share =
            wilson_interval(static_cast<double>(count) / static_cast<double>(decided), static_cast<double>(decided));
        const auto [regime, period] = class_of(a);
        Row row = place_of(results_, *image.record);
        row.insert(row.end(), {a + 1, regime, period, count, share.value, share.low, share.high});
        table.rows.push_back(std::move(row));
      }
    }
    return table;
  }

  Table differences() const {
    Table table = basin_differences_head();
    for (std::size_t a = 0; a < images_.size(); ++a)
      for (std::size_t b = a + 1; b < images_.size(); ++b) {
        int both = 0, differ = 0;
        for (std::size_t place = 0; place < images_[a].at.size(); ++place) {
          const int one = attractor_at(images_[a], place), other = attractor_at(images_[b], place);
          if (one < 0 || other < 0) continue;
          ++both;
          differ += one != other;
        }
        table.rows.push_back({images_[a].record->id, images_[b].record->id, both, differ,
                              both > 0 ? Cell(static_cast<double>(differ) / both) : Cell()});
      }
    return table;
  }

  int attractor_at(const Image& image, std::size_t place) const {
    return image.at[place] < 0 ? -1 : image.cells[static_cast<std::size_t>(image.at[place])].attractor;
  }

  Table uncertainty() const {
    Table table = table_of_cases(results_, basin_uncertainty_head());
    for (const Image& image : images_) {
      std::vector<int> labels;
      for (std::size_t place = 0; place < image.at.size(); ++place) labels.push_back(attractor_at(image, place));
      int known = 0, boundary = 0;
      for (std::size_t place = 0; place < labels.size(); ++place) {
        if (labels[place] < 0) continue;
        ++known;
        const auto around = neighbours(place);
        boundary += std::any_of(around.begin(), around.end(), [&](std::size_t other) {
          return labels[other] >= 0 && labels[other] != labels[place];
        });
      }
      Row row = place_of(results_, *image.record);
      row.push_back(known > 0 ? Cell(static_cast<double>(boundary) / known) : Cell());
      const auto exponent =
          labels.empty() ? std::nullopt
                         : uncertainty_exponent(labels, static_cast<int>(xs_.size()), static_cast<int>(ys_.size()));
      if (exponent)
        row.insert(row.end(), {exponent->value, exponent->low, exponent->high});
      else
        row.insert(row.end(), {nullptr, nullptr, nullptr});
      table.rows.push_back(std::move(row));
    }
    return table;
  }

  StudyResults& results_;
  const SweptColumns swept_ = swept_columns(results_);
  std::vector<Image> images_;
  std::vector<double> xs_, ys_;
  std::vector<std::string> kinds_;
  CloudPoint scale_ = {1, 1};
  bool initial_states_ = true;
  std::vector<std::vector<SettledSection>> leaders_;
  int attractors_ = 0;
  std::vector<int> kind_of_attractor_;
};

}  // namespace

void derive_basins(StudyResults& results) {
  const BasinImages images(results);
  if (!images.empty()) images.append_tables();
}

}  // namespace ricochet::dynamics
