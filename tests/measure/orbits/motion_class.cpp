// One spelling of the class of an orbit: what is written is read, and nothing else is.
#include <catch2/catch.hpp>
#include <limits>
#include <ricochet/measure/orbits/recurrence.hpp>
#include <ricochet/measure/orbits/regime.hpp>
#include <set>
#include <vector>

using namespace ricochet;

namespace motion_class_tests {

namespace {

std::vector<MotionClass> all_classes() {
  std::vector<MotionClass> all;
  for (const Regime regime : {Regime::no_contact, Regime::at_rest, Regime::quasi_periodic, Regime::chaotic,
                              Regime::undecided, Regime::failed})
    all.push_back({regime, 0});
  for (int period = 1; period <= 2 * longest_period; ++period) all.push_back({Regime::periodic, period});
  return all;
}

}  // namespace

TEST_CASE("motion class: every class is read from its own words, and from the two columns of a table") {
  std::set<std::string> words;
  for (const MotionClass& one : all_classes()) {
    const std::string said = text(one);
    INFO(said);
    CHECK(words.insert(said).second);
    CHECK(motion_class(said) == one);
    CHECK(motion_class(word(one.regime), one.period > 0 ? std::optional<double>(one.period) : std::nullopt) == one);
  }
  CHECK(words.count("no contact") == 1);
  CHECK(words.count("at rest") == 1);
  CHECK(words.count("periodic 3") == 1);
  CHECK(words.count("quasi-periodic") == 1);
}

TEST_CASE("motion class: what a motion without contact repeats after is no part of its class") {
  CHECK(motion_class("no contact", 1) == MotionClass{Regime::no_contact, 0});
  CHECK(motion_class("at rest", 2) == MotionClass{Regime::at_rest, 0});
  CHECK(motion_class("chaotic", 7) == MotionClass{Regime::chaotic, 0});
}

TEST_CASE("motion class: a motion whose contacts never change has a cycle, what never repeats has none") {
  for (const Regime regime : {Regime::no_contact, Regime::at_rest}) {
    CHECK(cycle_of({regime}, 0) == 1);
    CHECK(cycle_of({regime}, 3) == 3);
  }
  CHECK(cycle_of({Regime::periodic, 4}, 4) == 4);
  for (const Regime regime : {Regime::quasi_periodic, Regime::chaotic, Regime::undecided, Regime::failed})
    CHECK(cycle_of({regime}, 5) == 0);
}

TEST_CASE("motion class: other words are none") {
  for (const char* words :
       {"", "contact", "not periodic", "periodic", "periodic ", "periodic x", "periodic 3x", "periodic  3",
        "periodic 0", "periodic -1", "periodic 99999999999", "chaotic 3", "no contact 1", " chaotic", "Chaotic"}) {
    INFO('"' << words << '"');
    CHECK_FALSE(motion_class(words).has_value());
  }
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double period : {0.0, -2.0, infinity, nan}) CHECK_FALSE(motion_class("periodic", period).has_value());
  CHECK_FALSE(motion_class("periodic", std::nullopt).has_value());
}

TEST_CASE("motion class: what is undecided or failed is not decided") {
  for (const MotionClass& one : all_classes())
    CHECK(one.decided() == (one.regime != Regime::undecided && one.regime != Regime::failed));
  CHECK_FALSE(MotionClass{}.decided());
}

}  // namespace motion_class_tests

TEST_CASE("motion class: what chatters to its end is another motion than what hits and leaves") {
  const MotionClass single{Regime::periodic, 2}, complete{Regime::chattering, 2};
  CHECK_FALSE(single == complete);
  CHECK(text(complete) == "chattering 2");
  CHECK(motion_class("chattering 2") == complete);
  CHECK(motion_class("chattering", 2.0) == complete);
  CHECK_FALSE(motion_class("chattering"));
  CHECK(cycle_of(complete, 0) == 2);
  CHECK(complete.repeats());
  CHECK(complete.decided());
  CHECK_FALSE(MotionClass{Regime::at_rest}.repeats());
}
