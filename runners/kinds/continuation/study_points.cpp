#include "runners/kinds/continuation/study_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runners/answers/numbers_in_words.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/table_reader.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

constexpr const char* stiffness_column = "contact.stiffness";
/// A branch that goes on by this share of the range beyond a place has passed it.
constexpr double passed_share = 1e-3;

PointKind kind_of(const SpecialRow& row) {
  if (row.kind != PointKind::contact) return row.kind;
  if (row.runs_before == 0 || row.runs_after == 0) return PointKind::first_contact;
  return row.held_before != row.held_after ? PointKind::lift_off : row.kind;
}

/// Branches that go down from an orbit have arcs below zero.
double signed_arc(const SpecialRow& row) {
  const double arc = row.arc.value_or(0);
  return row.branch.ends_with("−") || row.branch.ends_with("-") ? -arc : arc;
}

}  // namespace

StudyPoints::StudyPoints(const Choices& study) : study_(study) {
  if (study.varies("steps_per_period"))
    axes_.push_back({"steps_per_period", "step", "h", [&](const CaseRecord& one) { return study.step(one); }});
  if (study.varies(study.mesh_column()))
    axes_.push_back({study.mesh_column(), "mesh", "ℓ", [&](const CaseRecord& one) -> std::optional<double> {
                       const auto elements = study.elements(one);
                       return elements && *elements > 0 ? std::optional(1 / *elements) : std::nullopt;
                     }});
  if (study.varies(stiffness_column) && study.numbers_of(stiffness_column).size() > 1)
    axes_.push_back({stiffness_column, "stiffness", "1/κ", [&](const CaseRecord& one) -> std::optional<double> {
                       const auto stiffness = number_in(study.text(one, stiffness_column));
                       return stiffness && *stiffness > 0 ? std::optional(1 / *stiffness) : std::nullopt;
                     }});
  for (const std::string& column : study.columns())
    if (std::none_of(axes_.begin(), axes_.end(), [&](const RefinedAxis& one) { return one.column == column; }))
      method_columns_.push_back(column);
  for (const CaseRecord& record : study.results().cases) read(record);
  const auto& given = study.results().study;
  if (const auto found = given.find("parameter"); found != given.end() && found->contains("from")) {
    const double length = std::abs(found->at("to").get<double>() - found->at("from").get<double>());
    if (length > 0) range_ = length;
  }
  if (cases_.empty()) return;
  find_root();
  find_heads();
  std::vector<CasePoint> points;
  std::vector<std::size_t> place;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const StudyPoint& one = points_[k];
    if (!changes_orbit(one.kind) || !one.row.parameter) continue;
    points.push_back(one);
    points.back().family = word(one.kind);
    points.back().turns = one.kind == PointKind::fold;
    if (one.branch >= 0)
      points.back().family += fmt::format(" of period {} {}", one.period,
                                          !one.symmetric   ? ""
                                          : *one.symmetric ? "symmetric"
                                                           : "not symmetric");
    place.push_back(k);
  }
  const PointScales scales{range_, tips_ > 0 ? tips_ : 1, arcs_ > 0 ? arcs_ : 1};
  const MatchedPoints matched = match_points(points, links(), scales);
  names_.resize(static_cast<std::size_t>(matched.names));
  for (std::size_t k = 0; k < place.size(); ++k) {
    points_[place[k]].name = matched.name[k];
    points_[place[k]].sharing = matched.sharing[k];
    if (matched.name[k] >= 0) place_.emplace(std::pair(points_[place[k]].owner, matched.name[k]), place[k]);
  }
  give_names();
}

void StudyPoints::read(const CaseRecord& record) {
  const Table* table = find_table(record.tables, branches_name);
  if (!table || table->rows.empty()) return;
  const std::size_t owner = cases_.size();
  std::vector<Branch> own;
  double low = 0, high = 0;
  bool any = false;
  for (const BranchRow& row : branch_rows_in(*table)) {
    if (!row.parameter) continue;
    auto found = std::find_if(own.begin(), own.end(), [&](const Branch& one) { return one.name == row.branch; });
    if (found == own.end())
      found = own.insert(own.end(), {row.branch, row.period, row.symmetric, {*row.parameter, *row.parameter}});
    found->reach.from = std::min(found->reach.from, *row.parameter);
    found->reach.to = std::max(found->reach.to, *row.parameter);
    arcs_ = std::max(arcs_, std::abs(row.arc.value_or(0)));
    if (!row.tip_displacement) continue;
    low = any ? std::min(low, *row.tip_displacement) : *row.tip_displacement;
    high = any ? std::max(high, *row.tip_displacement) : *row.tip_displacement;
    any = true;
  }
  if (own.empty()) return;
  tips_ = std::max(tips_, high - low);
  cases_.push_back(&record);
  method_.push_back(study_.key(record, method_columns_));
  for (SpecialRow& row : special_points_type().read(record.tables)) {
    const double at = row.parameter.value_or(NAN);
    StudyPoint one{
        {owner, -1, "", at, 0, row.tip_displacement.value_or(0), signed_arc(row), row.prominence.value_or(0)},
        kind_of(row)};
    for (const auto& end : {row.low, row.high})
      if (end) one.half = std::max(one.half, std::abs(*end - at));
    const auto branch = std::find_if(own.begin(), own.end(), [&](const Branch& of) { return of.name == row.branch; });
    if (branch != own.end()) {
      one.branch = static_cast<int>(branch - own.begin());
      one.period = branch->period;
      one.symmetric = branch->symmetric;
    }
    one.row = std::move(row);
    points_.push_back(std::move(one));
  }
  branches_.push_back(std::move(own));
  turns_.push_back(turns_type().read(record.tables));
}

bool StudyPoints::finer(std::size_t a, std::size_t b) const {
  // Mesh before stiffness before step: the axes in the order of their rank.
  for (const char* words : {"mesh", "stiffness", "step"})
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      if (axes_[axis].words != std::string(words)) continue;
      const double one = size(a, axis).value_or(HUGE_VAL), other = size(b, axis).value_or(HUGE_VAL);
      if (one != other) return one < other;
    }
  return false;
}

void StudyPoints::find_root() {
  std::vector<std::string> methods;
  const auto rank = [&](std::size_t c) {
    const auto found = std::find(methods.begin(), methods.end(), method_[c]);
    if (found != methods.end()) return found - methods.begin();
    methods.push_back(method_[c]);
    return static_cast<std::ptrdiff_t>(methods.size()) - 1;
  };
  for (std::size_t c = 0; c < cases_.size(); ++c) rank(c);
  for (std::size_t c = 1; c < cases_.size(); ++c) {
    const CaseRecord &one = *cases_[c], &best = *cases_[root_];
    if (study_.finer(one, best))
      root_ = c;
    else if (!study_.finer(best, one) && (rank(c) < rank(root_) || (rank(c) == rank(root_) && finer(c, root_))))
      root_ = c;
  }
}

void StudyPoints::find_heads() {
  std::map<std::string, std::size_t> place;
  for (std::size_t c = 0; c < cases_.size(); ++c) {
    const auto [at, fresh] = place.emplace(method_[c], heads_.size());
    if (fresh)
      heads_.push_back(c);
    else if (finer(c, heads_[at->second]))
      heads_[at->second] = c;
  }
  const auto own =
      std::find_if(heads_.begin(), heads_.end(), [&](std::size_t c) { return method_[c] == method_[root_]; });
  *own = root_;
  std::rotate(heads_.begin(), own, own + 1);
}

CaseLink StudyPoints::link_of(std::size_t c) const {
  // Step, mesh, stiffness: the next finer case that is equal in all that comes after.
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
    std::optional<std::size_t> next;
    for (std::size_t other = 0; other < cases_.size(); ++other) {
      if (other == c || method_[other] != method_[c]) continue;
      const auto own = size(c, axis), there = size(other, axis);
      if (!own || !there || *there >= *own) continue;
      bool equal = true;
      for (std::size_t after = axis + 1; after < axes_.size(); ++after) equal &= size(c, after) == size(other, after);
      if (!equal) continue;
      if (next && *size(*next, axis) > *there) continue;
      // Of equals in this axis the one that is nearest in those before, else the finer one.
      if (next && *size(*next, axis) == *there) {
        const auto differs = [&](std::size_t one) {
          int count = 0;
          for (std::size_t before = 0; before < axis; ++before) count += size(one, before) != size(c, before);
          return count;
        };
        if (differs(*next) < differs(other) || (differs(*next) == differs(other) && finer(*next, other))) continue;
      }
      next = other;
    }
    if (next) return {next, axes_[axis].column, true};
  }
  // Another method: the one nearest to this among those that are nearer to the reference.
  const auto choices = [&](std::size_t a, std::size_t b) {
    std::size_t count = 0;
    for (const std::string& column : method_columns_)
      count += study_.text(*cases_[a], column) != study_.text(*cases_[b], column);
    return count;
  };
  std::size_t best = root_;
  for (const std::size_t head : heads_)
    if (method_[head] != method_[c] && choices(head, root_) < choices(c, root_) && choices(head, c) < choices(best, c))
      best = head;
  return {best, "method", false};
}

std::vector<CaseLink> StudyPoints::links() const {
  std::vector<CaseLink> out(cases_.size());
  for (std::size_t c = 0; c < cases_.size(); ++c)
    if (c != root_) out[c] = link_of(c);
  return out;
}

const StudyPoint* StudyPoints::find(std::size_t owner, int name) const {
  const auto found = place_.find({owner, name});
  return found == place_.end() ? nullptr : &points_[found->second];
}

PointPresence StudyPoints::presence(std::size_t owner, int name, std::optional<BranchReach>* passed) const {
  const StudyPoint* point = find(owner, name);
  const StudyPoint& named = *names_[static_cast<std::size_t>(name)].point;
  std::vector<BranchReach> reaches;
  for (const Branch& one : branches_[owner])
    if (one.period == named.period && one.symmetric == named.symmetric) reaches.push_back(one.reach);
  return presence_of(named.parameter, passed_share * range_, point ? point->sharing : 0, reaches, passed);
}

std::vector<std::size_t> StudyPoints::along(std::size_t head, std::size_t axis) const {
  std::vector<std::size_t> out;
  for (std::size_t c = 0; c < cases_.size(); ++c) {
    bool equal = method_[c] == method_[head] && size(c, axis);
    for (std::size_t other = 0; other < axes_.size(); ++other)
      equal &= other == axis || size(c, other) == size(head, other);
    if (equal) out.push_back(c);
  }
  return out;
}

std::vector<PointLevel> StudyPoints::levels(std::size_t case_of_chain, std::size_t axis, int name) const {
  std::vector<PointLevel> out;
  for (const std::size_t c : along(case_of_chain, axis)) {
    // Where other turns share its place it is not known which one it is.
    const StudyPoint* point = find(c, name);
    if (point && point->sharing == 1) out.push_back({*size(c, axis), point->parameter, point->half});
  }
  return out;
}

PointConvergence StudyPoints::convergence(std::size_t head, int name) const {
  PointConvergence out;
  out.finest = head;
  out.point = find(head, name);
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
    // The order where most sizes have the point, of equals the finest; the limit at the finest of all others.
    const std::vector<PointLevel> own = levels(head, axis, name);
    std::vector<PointLevel> most = own;
    std::size_t finest = head;
    for (std::size_t c = 0; c < cases_.size(); ++c) {
      if (method_[c] != method_[head] || !size(c, axis)) continue;
      std::vector<PointLevel> other = levels(c, axis, name);
      if (other.size() < most.size() || (other.size() == most.size() && !finer(c, finest))) continue;
      most = std::move(other);
      finest = c;
    }
    if (most.size() < 2) continue;
    PointConvergence::Along one{axis, most.size(), finest, point_order(most), {}};
    const PointOrder here = point_order(own);
    if (own.size() > 1) one.limit = point_limit(own, here.told ? here : one.order);
    out.along.push_back(std::move(one));
  }
  if (!out.point) return out;
  out.value = out.point->parameter;
  // What is left open adds up, whichever refinement leaves it.
  for (const PointConvergence::Along& one : out.along) {
    out.value += one.limit.correction;
    if (one.limit.open) out.half = out.half.value_or(out.point->half) + *one.limit.open;
  }
  return out;
}

std::vector<std::string> StudyPoints::differences(std::size_t a, std::size_t b) const {
  std::vector<std::string> out;
  for (const std::string& choice : study_.choices())
    for (const std::string& column : study_.columns_of(choice))
      if (study_.text(*cases_[a], column) != study_.text(*cases_[b], column)) {
        out.push_back(choice);
        break;
      }
  for (const RefinedAxis& axis : axes_)
    if (axis.column != stiffness_column &&
        study_.text(*cases_[a], axis.column) != study_.text(*cases_[b], axis.column) &&
        std::find(out.begin(), out.end(), axis.column) == out.end())
      out.push_back(axis.column);
  return out;
}

std::string StudyPoints::level(std::size_t owner, const std::string& choice) const {
  const std::string& text = study_.text(*cases_[owner], choice);
  return is_refinement(choice) ? text : study_.level(*cases_[owner], choice);
}

void StudyPoints::give_names() {
  const auto take = [&](const StudyPoint& one) {
    if (one.name < 0) return;
    const StudyPoint*& point = names_[static_cast<std::size_t>(one.name)].point;
    if (!point) point = &one;
  };
  // The reference and the finest cases of other methods first.
  for (const std::size_t head : heads_)
    for (const StudyPoint& one : points_)
      if (one.owner == head) take(one);
  for (const StudyPoint& one : points_) take(one);
  std::vector<double> limits;
  for (std::size_t k = 0; k < names_.size(); ++k) {
    const PointConvergence one = convergence(names_[k].point->owner, static_cast<int>(k));
    limits.push_back(one.point ? one.value : names_[k].point->parameter);
  }
  const auto text = [&](std::size_t k, int digits) {
    const StudyPoint& point = *names_[k].point;
    const std::string period = point.period > 1 ? fmt::format("period {} ", point.period) : "";
    return fmt::format("{}{} at {}", period, word(point.kind), short_number(limits[k], digits));
  };
  constexpr int fewest = 4, most = 9;
  for (std::size_t k = 0; k < names_.size(); ++k) {
    int digits = fewest;
    const auto twin = [&](std::size_t other) { return other != k && text(other, digits) == text(k, digits); };
    const auto any_twin = [&] {
      for (std::size_t other = 0; other < names_.size(); ++other)
        if (twin(other)) return true;
      return false;
    };
    while (digits < most && any_twin()) ++digits;
    names_[k].text = text(k, digits);
    int before = 0;
    for (std::size_t other = 0; other < k; ++other) before += twin(other);
    if (before > 0) names_[k].text += fmt::format(" ({})", before + 1);
  }
}

}  // namespace ricochet
