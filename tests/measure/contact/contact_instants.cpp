// What closes, opens and changes its side, whatever the number of stages that ask.
#include <catch2/catch.hpp>
#include <ricochet/measure/contact/contact_instants.hpp>

#include "tests/allocations.hpp"

using namespace ricochet;

TEST_CASE("an impact is a point that closes, whether or not another is closed") {
  ClosedPoints closed(3);
  closed.press(1, 5.0);
  ClosedPoints::Change first = closed.end_instant();
  CHECK(first.closings == 1);
  CHECK(first.active == 1);
  CHECK_FALSE(first.was_active);
  // Point 1 stays, point 2 closes; two stages press it.
  closed.press(1, 4.0);
  closed.press(2, -1.0);
  closed.press(2, -2.0);
  const ClosedPoints::Change second = closed.end_instant();
  CHECK(second.closings == 1);
  CHECK(second.active == 2);
  CHECK(second.was_active);
  CHECK(second.changed);
  // The same two: nothing changes.
  closed.press(2, -1.0);
  closed.press(1, 4.0);
  CHECK_FALSE(closed.end_instant().changed);
  // Point 2 goes over to the other stop without an instant between: it closes anew.
  closed.press(1, 4.0);
  closed.press(2, 1.0);
  CHECK(closed.end_instant().closings == 1);
  const ClosedPoints::Change last = closed.end_instant();
  CHECK(last.closings == 0);
  CHECK(last.active == 0);
  CHECK(last.changed);
  CHECK(closed.idle());
}

TEST_CASE("what was closed and what is are told once for each point") {
  ClosedPoints closed(4);
  closed.press(3, 1.0);
  closed.end_instant();
  closed.press(0, -1.0);
  const long before = allocations();
  int told = 0;
  bool right = true;
  closed.end_instant([&](int point, int was, int now) {
    ++told;
    right = right && ((point == 3 && was == 1 && now == 0) || (point == 0 && was == 0 && now == -1));
  });
  int closed_now = -1;
  closed.each([&](int point) { closed_now = point; });
  const long after = allocations();
  CHECK(after == before);
  CHECK(told == 2);
  CHECK(right);
  CHECK(closed_now == 0);
}
