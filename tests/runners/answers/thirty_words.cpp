// Sentences of at most thirty words keep what must be said, and of the reason what comes first.
#include "runners/answers/thirty_words.hpp"

#include <catch2/catch.hpp>
#include <random>

using ricochet::answers::fits, ricochet::answers::with_reason, ricochet::answers::words_in;

TEST_CASE("a reason that fits is told as it is") {
  CHECK(with_reason("Left out: 2 refused", "b does not apply") == "Left out: 2 refused: b does not apply.");
  CHECK(with_reason("Left out: 2 still running", "") == "Left out: 2 still running.");
  CHECK(with_reason("Doubtful: 1 of 2 cases", "h = 0.1 s is long", ", in the first of them") ==
        "Doubtful: 1 of 2 cases: h = 0.1 s is long, in the first of them.");
  CHECK(with_reason("Left out: 1 refused", "it ends. Use another.") == "Left out: 1 refused: it ends. Use another.");
}

TEST_CASE("a long reason loses its brackets, then its last clauses") {
  const std::string must = "Left out: 10 refused";
  CHECK(with_reason(
            must,
            "beta = 0.1 < 0.25 makes the kernel of a singular mass diverge at any step (roots of βr² + (1 − 2β) r + "
            "β outside the unit circle). Use beta ≥ 0.25 of newmark-dumont-paoli") ==
        "Left out: 10 refused: beta = 0.1 < 0.25 makes the kernel of a singular mass diverge at any step. Use beta ≥ "
        "0.25 "
        "of newmark-dumont-paoli.");
  const std::string long_clause = " and on and on and on and on and on and on";
  CHECK(with_reason(must, "contact is lost: a" + long_clause + ", b" + long_clause, ", in the first of them") ==
        "Left out: 10 refused: contact is lost: a" + long_clause + ".");
  // What stands behind numbers goes with them.
  CHECK(with_reason(must, "contact is lost: 3" + long_clause + long_clause, ", in the first of them") ==
        "Left out: 10 refused: contact is lost.");
}

TEST_CASE("thirty words hold any reason whose first clause they hold") {
  std::mt19937 random(7);
  const char* const marks[] = {" ", " ", " ", ", ", ": ", "; ", ". ", " ("};
  for (int draw = 0; draw < 3000; ++draw) {
    std::string reason = "first clause";
    bool open = false;
    for (std::size_t k = random() % 60; k > 0; --k) {
      std::string mark = marks[random() % std::size(marks)];
      if (mark == " (" && open) mark = ") ";
      open = mark == " (" ? true : mark == ") " ? false : open;
      reason += mark + "w" + std::to_string(random() % 100);
    }
    const std::string must = "Doubtful: 3 of 5 cases", told = with_reason(must, reason, ", in the first of them");
    INFO(reason);
    INFO(told);
    CHECK(told.starts_with(must + ": first clause"));
    CHECK(told.ends_with("."));
    const std::string whole = must + ": " + reason + ", in the first of them.";
    if (fits(whole)) CHECK(words_in(told) >= words_in(must + ": " + reason));
    // The first clause alone may be longer.
    std::string shown = told.substr(must.size() + 2);
    if (const std::size_t ending = shown.rfind(", in the first of them"); ending != std::string::npos)
      shown.resize(ending);
    if (!fits(told))
      for (const char* end : {". ", "; ", ": ", ", "}) CHECK(shown.find(end) == std::string::npos);
  }
}
