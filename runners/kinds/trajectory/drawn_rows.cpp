#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ricochet/scene/bodies.hpp>
#include <ricochet/scene/checks.hpp>
#include <ricochet/scene/clearances.hpp>
#include <ricochet/scene/named_stops.hpp>
#include <ricochet/scene/planes.hpp>
#include <ricochet/scene/structure/node_layout.hpp>

#include "runners/kinds/trajectory/snapshot_taker.hpp"
#include "runners/study/body_keys.hpp"

namespace ricochet {
namespace {

using Direction = std::array<double, 2>;

constexpr std::array<const char*, 3> components = {"ux", "uy", "uz"};
// Of several bodies, their rows are so much of the longest apart.
constexpr double apart = 0.16;

// A structure, alone or a body, and its places among those of the film.
struct FilmPart {
  std::string name = {};  // of the body
  const SceneSpec* alone = nullptr;
  const FiniteElementSpace* space = nullptr;
  std::optional<NodeLayout> layout = {};
  std::vector<double> x = {};  // of its places, m; empty for those of files
  std::size_t first = 0;

  const AssembledStructure* files() const {
    const auto* spec = std::get_if<AssembledSpec>(&alone->structure);
    return spec ? spec->structure.get() : nullptr;
  }
  bool along() const {
    return std::holds_alternative<BarSpec>(alone->structure) ||
           std::holds_alternative<OscillatorSpec>(alone->structure);
  }
  bool two_planes() const { return !space->across.empty(); }
};

class FilmShape {
 public:
  FilmShape(const SceneSpec& scene, const SemiDiscrete& problem) : scene_(scene), problem_(problem) {
    if (const JoinedBodies* bodies = bodies_of(scene.structure))
      for (const JoinedBody& body : bodies->all) parts_.push_back({body.name, &body.alone, &body.space});
    else
      parts_.push_back({"", &scene, &problem.space});
    joined_ = parts_.size() > 1;
    for (FilmPart& part : parts_) lay_out(part);
    oblique_ = std::any_of(parts_.begin(), parts_.end(), [](const FilmPart& one) { return one.two_planes(); });
    // Nodes on a plane have two displacements each.
    plane_ = joined_ || oblique_ || parts_.front().layout;
    place_bodies();
    for (FilmPart& part : parts_) add(part);
    add_stops();
    if (joined_ && !oblique_) shape_.axes = {0, 1};
    if (oblique_) shape_.axes = {2, 1};
  }

  DrawnRows rows() && {
    DrawnRows out{
        std::move(shape_), SparseRows(static_cast<Eigen::Index>(values_.size()), problem_.space.dofs), {}, {}};
    std::vector<Eigen::Triplet<double>> entries;
    const Eigen::Index supports = problem_.static_modes.cols();
    Eigen::MatrixXd held = Eigen::MatrixXd::Zero(out.rows.rows(), supports);
    for (std::size_t i = 0; i < values_.size(); ++i) {
      for (const auto& [dof, value] : values_[i].free) entries.emplace_back(static_cast<int>(i), dof, value);
      for (const auto& [support, weight] : values_[i].held)
        if (support < supports) held(static_cast<Eigen::Index>(i), support) += weight;
    }
    out.rows.setFromTriplets(entries.begin(), entries.end());
    out.on_supports = held;
    out.by_clamp = Eigen::VectorXd::Zero(out.rows.rows());
    if (supports > 0) {
      out.on_supports += out.rows * problem_.static_modes;
      out.by_clamp = out.on_supports.rowwise().sum();
    }
    if (!problem_.space.given) {
      out.by_clamp.setOnes();
      // A motion of all supports is along y.
      for (Eigen::Index i = 0; oblique_ && i < out.by_clamp.size(); i += 2) out.by_clamp[i] = 0;
    }
    return out;
  }

 private:
  bool named(const Place& place, const FilmPart& part) const { return !joined_ || place.body == part.name; }
  std::vector<const Place*> places_of(const FilmPart& part) const {
    std::vector<const Place*> out;
    for (const NamedStop& stop : scene_.stops.named)
      for (const Place* place : {&stop.at, stop.to ? &*stop.to : nullptr})
        if (place && named(*place, part)) out.push_back(place);
    return out;
  }

  // Places along a structure: its nodes where there are many, else as fine as the eye wants its cubics.
  void lay_out(FilmPart& part) const {
    const auto& elements = part.space->elements;
    if (const AssembledStructure* files = part.files()) {
      std::vector<std::string> wanted;
      for (const Place* place : places_of(part)) wanted.push_back(node_of(*files, *place));
      part.layout = node_layout(*files, wanted, Snapshots::most_nodes / parts_.size());
      return;
    }
    part.x = {0};
    if (elements.empty()) return;
    constexpr int smooth = 25;
    const int most = std::max(
        smooth, std::min<int>(Snapshots::most_places, Snapshots::most_nodes / static_cast<int>(parts_.size())));
    const int count = std::min(most, std::max(static_cast<int>(elements.size()) + 1, smooth));
    part.x = node_positions(structure_length(*part.alone), count - 1);
  }

  void place_bodies() {
    std::vector<BodyShape> shapes;
    for (const FilmPart& part : parts_) {
      BodyShape& shape = shapes.emplace_back(BodyShape{0, part.x.empty() ? 0 : part.x.back(), part.along()});
      if (part.layout)
        shape = {part.layout->places.front()[0], part.layout->places.back()[0] - part.layout->places.front()[0], false};
      longest_ = std::max(longest_, shape.length);
    }
    if (!(longest_ > 0)) longest_ = 1;
    std::vector<BodyMeeting> meetings;
    for (const NamedStop& stop : scene_.stops.named) {
      if (!joined_ || !stop.to || stop.at.body == stop.to->body) continue;
      const std::size_t at = part_of(stop.at), to = part_of(*stop.to);
      meetings.push_back({at, to, own_x(parts_[at], stop.at), own_x(parts_[to], *stop.to), stop.upper || !stop.lower});
    }
    bodies_ = body_places(shapes, meetings);
    columns_ = joined_ && all_along(shapes);
  }
  std::size_t part_of(const Place& place) const {
    for (std::size_t b = 0; b < parts_.size(); ++b)
      if (named(place, parts_[b])) return b;
    return 0;
  }
  static double own_x(const FilmPart& part, const Place& place) {
    if (part.along()) return 0;
    if (place.x) return *place.x;
    const int node = part.layout ? drawn_place(*part.files(), *part.layout, place).node : -1;
    return node < 0 ? 0 : part.layout->places[static_cast<std::size_t>(node)][0];
  }

  PlaceRow row(const FilmPart& part, Place place, const char* component) const {
    place.body = joined_ ? part.name : "";
    if (component) place.component = component;
    return place_row(scene_, problem_.space, place, "");
  }
  // A place at (x, y) with what it is displaced by along both axes of the drawing, or along its only one.
  int add_place(const std::string& name, double x, double y, const std::array<PlaceRow, 2>& moves) {
    shape_.x.push_back(x);
    if (plane_ || !name.empty()) shape_.names.push_back(name);
    if (plane_) shape_.y.push_back(y);
    values_.push_back(moves[0]);
    if (plane_) values_.push_back(moves[1]);
    return static_cast<int>(shape_.x.size()) - 1;
  }

  void add(FilmPart& part) {
    part.first = shape_.x.size();
    const BodyPlace body = bodies_[static_cast<std::size_t>(&part - parts_.data())];
    if (joined_) shape_.bodies.emplace_back(part.name, static_cast<int>(part.first));
    const double low = joined_ && !columns_ ? apart * longest_ * body.row : 0;
    const double left = columns_ ? (1 + apart / 2) * longest_ * body.row : joined_ ? body.shift : 0;
    const std::string prefix = joined_ ? part.name + " " : "";
    if (const AssembledStructure* files = part.files()) return add_files(part, *files, left, low, prefix);
    const double length = part.x.back();
    for (const double x : part.x) {
      Place place;
      place.x = x;
      std::array<PlaceRow, 2> moves;
      if (part.two_planes())
        moves = {row(part, place, "uz"), row(part, place, "uy")};
      else
        moves[plane_ && !columns_ ? 1 : 0] = row(part, place, nullptr);
      const bool upright = joined_ && !columns_ && part.along();
      const double lifted = upright && length > 0 ? low + (x / length - 0.5) * apart * longest_ / 2 : low;
      const bool one = part.x.size() == 1;
      add_place(!plane_ ? ""
                : one   ? part.name
                        : fmt::format("{}x = {:.4g} m", prefix, x),
                upright ? left : left + x, lifted, moves);
    }
    for (std::size_t k = part.first; plane_ && k + 1 < shape_.x.size(); ++k)
      shape_.links.emplace_back(static_cast<int>(k), static_cast<int>(k) + 1);
    const auto* beam = std::get_if<BeamSpec>(&part.alone->structure);
    for (const BeamSupport& support : beam&& plane_ ? supports_of(*beam) : std::vector<BeamSupport>())
      if (support.holds_displacement()) shape_.held.push_back(static_cast<int>(std::lround(index(part, support.x))));
  }

  void add_files(const FilmPart& part, const AssembledStructure& files, double left, double low,
                 const std::string& prefix) {
    if (!part.layout) return add_points(part, files, left, low, prefix);
    const NodeLayout& layout = *part.layout;
    const auto first = static_cast<int>(part.first);
    shape_.axes = layout.axes;
    for (std::size_t i = 0; i < layout.names.size(); ++i) {
      const AssembledStructure::Node& node = files.nodes.at(layout.names[i]);
      std::array<PlaceRow, 2> moves;
      for (std::size_t k = 0; k < 2; ++k) {
        Place place;
        place.node = layout.names[i];
        const char* component = components[oblique_ ? 2 - k : layout.axes[k]];
        if (node.dofs.contains(component)) moves[k] = row(part, place, component);
      }
      add_place(prefix + layout.names[i], left + layout.places[i][0], low + layout.places[i][1], moves);
    }
    for (const auto& [a, b] : layout.links) shape_.links.emplace_back(first + a, first + b);
    for (const int node : layout.held) shape_.held.push_back(first + node);
  }

  // Points without a place: those of modes, else of stops and what the study shows.
  void add_points(const FilmPart& part, const AssembledStructure& files, double left, double low,
                  const std::string& prefix) {
    const auto place = [&](const std::string& name, PlaceRow row) {
      const double x = static_cast<double>(shape_.x.size() - part.first);
      std::array<PlaceRow, 2> moves;
      moves[plane_ ? 1 : 0] = std::move(row);
      return add_place(prefix + name, joined_ ? left + 0.1 * longest_ * x : x, low, moves);
    };
    if (files.modes)
      for (const auto& [name, ignored] : files.modes->points)
        if (shape_.x.size() - part.first < static_cast<std::size_t>(Snapshots::most_places)) {
          Place point;
          point.point = name;
          place(name, row(part, point, nullptr));
        }
    const auto known = [&](const std::string& name) {
      const auto begin = shape_.names.begin() + static_cast<std::ptrdiff_t>(part.first);
      const auto found = std::find(begin, shape_.names.end(), name);
      return found == shape_.names.end() ? -1 : static_cast<int>(found - shape_.names.begin());
    };
    for (std::size_t i = 0; i < scene_.stops.named.size(); ++i) {
      const NamedStop& stop = scene_.stops.named[i];
      for (const Place* one : {&stop.at, joined_ && stop.to ? &*stop.to : nullptr}) {
        if (!one || !named(*one, part)) continue;
        const bool own = !joined_ && (stop.to || one->point.empty());
        const std::string name = !one->point.empty() ? one->point : joined_ ? stop.name : "";
        int& index = points_[one] = own ? -1 : known(prefix + name);
        if (index < 0)
          index = place(joined_ ? name : stop.name,
                        joined_ ? row(part, *one, nullptr) : stop_row(scene_, problem_.space, stop, i));
      }
    }
    if (!files.modes && !joined_)
      for (const PointSpec& one : scene_.points) place(one.name, files.row(one.at, ""));
    if (shape_.x.size() == part.first && !joined_)
      place("tip", given_tip(std::get<AssembledSpec>(scene_.structure), scene_));
  }
  // Between two places of a structure, a share of the way from one to the next.
  static double index(const FilmPart& part, double x) {
    const auto first = static_cast<double>(part.first);
    if (part.x.size() < 2) return first;
    const double last = static_cast<double>(part.x.size() - 1);
    return first + std::clamp(x / part.x.back() * last, 0.0, last);
  }
  double at(const Place& place) const {
    const FilmPart& part = parts_[part_of(place)];
    if (!part.files()) return index(part, place.x.value_or(0));
    if (const auto found = points_.find(&place); found != points_.end()) return found->second;
    if (!part.layout) return -1;
    const int node = drawn_place(*part.files(), *part.layout, place).node;
    return node < 0 ? -1 : static_cast<double>(part.first) + node;
  }
  Direction direction(const Place& place) const {
    const FilmPart& part = parts_[part_of(place)];
    if (part.layout) return drawn_place(*part.files(), *part.layout, place).direction;
    if (part.two_planes()) {
      const std::array<double, 2> shares = plane_shares(place, true, "");
      return {shares[1], shares[0]};
    }
    return plane_ && !columns_ ? Direction{0, 1} : Direction{1, 0};
  }

  void add_stops() {
    for (const NamedStop& stop : scene_.stops.named) {
      Direction towards = direction(stop.at);
      if (stop.side) {
        const auto [first, second] = side_direction(stop.side->angle);
        const Direction across = direction(stop.side->across);
        for (const std::size_t k : {0, 1}) towards[k] = first * towards[k] + second * across[k];
      }
      // A point of a stop of its own shows what the stop bounds.
      const bool between = stop.to && (joined_ || !parts_.front().files() || plane_);
      shape_.stops.push_back({at(stop.at), between ? at(*stop.to) : -1, towards, stop.name});
    }
    for (std::size_t i = 0; scene_.stops.named.empty() && i < problem_.contact_x.size(); ++i)
      shape_.stops.push_back({index(parts_.front(), problem_.contact_x[i]), -1, direction({}), ""});
  }

  const SceneSpec& scene_;
  const SemiDiscrete& problem_;
  std::vector<FilmPart> parts_;
  std::vector<BodyPlace> bodies_;
  bool joined_ = false, oblique_ = false, plane_ = false, columns_ = false;
  double longest_ = 0;
  Snapshots shape_;
  std::vector<PlaceRow> values_;
  std::map<const Place*, int> points_;  // of stops that points stand for
};

}  // namespace

DrawnRows drawn_rows(const SceneSpec& scene, const SemiDiscrete& problem) {
  if (problem.circles().empty()) return FilmShape(scene, problem).rows();
  SceneSpec met = scene;
  met.stops = with_circles(std::move(met.stops));
  return FilmShape(met, problem).rows();
}

}  // namespace ricochet
