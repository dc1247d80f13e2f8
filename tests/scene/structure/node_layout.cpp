// Where nodes of matrices that are given are drawn.
#include <catch2/catch.hpp>
#include <ricochet/scene/structure/node_layout.hpp>

#include "tests/scene/structure/plane_frame.hpp"

using namespace ricochet;
using namespace ricochet::testing;

namespace {

AssembledStructure arch_structure(bool places = true) {
  return assembled(frame_files(arch(), places));
}

}  // namespace

TEST_CASE("nodes stand on the plane of their largest extents, joined as the stiffness joins them") {
  const AssembledStructure structure = arch_structure();
  const std::optional<NodeLayout> layout = node_layout(structure, {}, 100);
  REQUIRE(layout);
  CHECK(layout->axes == std::array<std::size_t, 2>{0, 1});
  REQUIRE(layout->names.size() == 11);
  CHECK(layout->links.size() == 10);  // an element each
  for (const auto& [a, b] : layout->links) {
    const auto &p = layout->places[static_cast<std::size_t>(a)], &q = layout->places[static_cast<std::size_t>(b)];
    // The chord of 0.314 rad.
    CHECK(std::hypot(p[0] - q[0], p[1] - q[1]) == Approx(2 * std::sin(0.157)).epsilon(1e-12));
  }
  REQUIRE(layout->held.size() == 1);
  CHECK(layout->names[static_cast<std::size_t>(layout->held.front())] == "N0");
}

TEST_CASE("of many nodes those asked for are kept, and neighbours stay joined") {
  const AssembledStructure structure = arch_structure();
  const std::optional<NodeLayout> layout = node_layout(structure, {"N7"}, 5);
  REQUIRE(layout);
  CHECK(layout->names.size() <= 5);
  CHECK(layout->find("N7") >= 0);
  // A chain stays one.
  CHECK(layout->links.size() == layout->names.size() - 1);
}

TEST_CASE("nodes without places have no layout") {
  CHECK_FALSE(node_layout(arch_structure(false), {}, 100));
}

TEST_CASE("a place is drawn at its node, along its component, its direction or its weights") {
  const AssembledStructure structure = arch_structure();
  const NodeLayout layout = node_layout(structure, {}, 100).value();
  Place place;
  place.node = "N5";
  place.component = "uy";
  CHECK(drawn_place(structure, layout, place).direction == std::array<double, 2>{0, 1});
  CHECK(drawn_place(structure, layout, place).node == layout.find("N5"));
  place.component.clear();
  place.direction = {3, 4, 0};
  CHECK(drawn_place(structure, layout, place).direction == std::array<double, 2>{0.6, 0.8});
  place = {};
  place.dofs = {{structure.nodes.at("N5").dofs.at("ux"), 0.5}, {structure.nodes.at("N6").dofs.at("ux"), 0.5}};
  CHECK(drawn_place(structure, layout, place).direction == std::array<double, 2>{0.5, 0});
  CHECK(node_of(structure, place) == "N5");
}
