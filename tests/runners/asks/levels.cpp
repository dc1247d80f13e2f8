// Of which level, stop and value a verdict speaks, and what is not settled.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <ricochet/contract/said_format.hpp>
#include <set>

#include "runners/answers/answer.hpp"
#include "runners/answers/limits.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/run/analysed_results.hpp"
#include "runners/store/study_tables.hpp"
#include "tests/runners/asks/made_tables.hpp"

using namespace ricochet;
using namespace ricochet::asks;

TEST_CASE("asks: what still moves with the step decides only where it is far") {
  // m1 rises by a thousandth at each halving, as slowly as that; both are 9 % apart.
  const std::vector<double> settled = {1.001, 1.0005, 1.00025, 1.000125}, moves = {0.909, 0.91, 0.911, 0.912};
  const StudyResults results = two_methods(settled, moves);
  const auto answered = [&](const Json& ask) { return answer_of(results, ask); };
  CHECK(answered({{"effect", "mass"}, {"on", "impulse"}, {"within", 0.1}}).passes == Verdict::open);
  CHECK(answered({{"effect", "mass"}, {"on", "impulse"}, {"from", 0.02}}).passes == Verdict::yes);
  CHECK(answered({{"effect", "mass"}, {"on", "impulse"}, {"within", 0.5}}).passes == Verdict::yes);
  CHECK(answered({{"limit", "impulse"}, {"below", 1.1}}).passes == Verdict::yes);
  const Answered near = answered({{"limit", "impulse"}, {"above", 0.9}});
  CHECK(near.passes == Verdict::open);
  CHECK(near.reason == "it still rises with the step");
  const Answered known = answered({{"enough", "impulse"}, {"within", 0.01}});
  INFO(known.sentence);
  CHECK(known.passes == Verdict::open);
  CHECK(known.reason == "it still rises with the step");
  // What settles is told at the same distance.
  const StudyResults others = two_methods(settled, {0.912, 0.911, 0.9105, 0.91025});
  CHECK(answer_of(others, {{"effect", "mass"}, {"on", "impulse"}, {"within", 0.1}}).passes == Verdict::yes);
  CHECK(answer_of(others, {{"limit", "impulse"}, {"above", 0.9}}).passes == Verdict::yes);
}

TEST_CASE("asks: a value is passed between two levels, a count is met on one") {
  Made made;
  made.choices = {{"mass", {"m0", "m1"}}, {"stops.upper", {"1", "2", "3", "4"}}};
  made.error = 1e-3;
  const auto answered = [&](bool counts, double is) {
    made.truth = [=](const std::vector<std::size_t>& at) {
      const double value = 10 * static_cast<double>(at[1] + 1) + (counts ? 0 : 0.5 * static_cast<double>(at[0]));
      return value;
    };
    if (counts) made.error = 0;
    StudyResults results = made.results();
    for (CaseRecord& record : results.cases)
      record.axes[1].second = std::stod(record.axes[1].second.get<std::string>());
    return answer_of(results, {{"threshold", "impulse"}, {"is", is}, {"along", "stops.upper"}});
  };
  const Answered passed = answered(false, 25);
  INFO(passed.sentence);
  CHECK(passed.passes == Verdict::yes);
  CHECK(passed.sentence.find("Between 2 and 3") == 0);
  CHECK(passed.sentence.find("larger beyond") != std::string::npos);
  std::set<std::string> verdicts;
  for (const VerdictRow& row : passed.rows) verdicts.insert(row.verdict);
  CHECK(verdicts == std::set<std::string>{"above", "below", "threshold"});
  const Answered never = answered(false, 5);
  CHECK(never.verdict == "never");
  CHECK(never.sentence.find("always above 5") != std::string::npos);
  CHECK(answered(false, 500).sentence.find("always below 500") != std::string::npos);
  CHECK(answered(true, 20).verdict == "not monotone");  // on one level of four
  CHECK(answered(true, 40).passes == Verdict::yes);
}

TEST_CASE("asks: a measure that each stop has is told of each, and of one stop as it is") {
  Made made;
  made.choices = {{"mass", {"m0", "m1"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 3.0; };
  made.error = 1e-3;
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases) {
    record.measures.emplace_back("impulse[p1]", 2.0 * record.measures.front().second / 3);
    record.measures.emplace_back("impulse[p2]", record.measures.front().second / 3);
  }
  const Answered answered = answer_of(results, {{"limit", "impulse"}, {"above", 1.5}});
  INFO(answered.sentence);
  CHECK(answered.passes == Verdict::no);
  CHECK(answered.sentence.find("p2") != std::string::npos);
  CHECK(answer_of(results, {{"limit", "impulse"}, {"above", 1.5}, {"stops", {"p1"}}}).passes == Verdict::yes);
  for (CaseRecord& record : results.cases) record.measures.pop_back();
  CHECK(answer_of(results, {{"limit", "impulse"}, {"above", 2.5}}).passes == Verdict::yes);
}

TEST_CASE("asks: choices with one word are told by what has them") {
  Made made;
  made.choices = {{"mass", {"m0"}}, {"stops.0.upper", {"1", "2"}}, {"stops.1.upper", {"1", "2"}}};
  made.truth = [](const std::vector<std::size_t>& at) { return 1.0 + static_cast<double>(at[1] + 2 * at[2]); };
  made.error = 1e-3;
  StudyResults results = made.results();
  results.study["scene"]["stops"] = {{{"name", "plate"}}, {{"name", "bar"}}};
  for (CaseRecord& record : results.cases)
    for (const std::size_t k : {1, 2}) record.axes[k].second = std::stod(record.axes[k].second.get<std::string>());
  const Answered value = answer_of(results, {{"value", "impulse"}});
  CHECK(value.rows.front().level == "plate upper 1 m, bar upper 1 m");
  const Answered effect = answer_of(results, {{"effect", "stops.1.upper"}, {"on", "impulse"}, {"from", 0.01}});
  INFO(effect.sentence);
  CHECK(effect.sentence.find("upper stop at bar") != std::string::npos);
  // Whatever is asked, levels stand in the study's order.
  for (const VerdictRow& row : answer_of(results, {{"rank", "impulse"}, {"over", "stops.0.upper"}}).rows)
    CHECK(row.level.find("plate") < row.level.find("bar"));
}

TEST_CASE("asks: two sizes decide three times what first order leaves of them") {
  Made made;
  made.choices = {{"mass", {"m0"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  made.error = 0.2;
  const auto below = [&](const std::vector<double>& steps, double bound) {
    made.steps = steps;
    return answer_of(made.results(), {{"limit", "impulse"}, {"below", bound}});
  };
  // Halved: 1.2, 1.1; u = 0.1 decides 0.3 away. A tenth: 1.2, 1.02; u = 0.18 is eight times what is left.
  const Answered near = below({4e-3, 2e-3}, 1.35);
  INFO(near.sentence);
  CHECK(near.passes == Verdict::open);
  CHECK(near.reason == "it is known by two steps alone");
  CHECK(below({4e-3, 2e-3}, 1.45).passes == Verdict::yes);
  CHECK(below({4e-3, 4e-4}, 1.25).passes == Verdict::yes);
}

TEST_CASE("asks: runs that end at times of their own are told, those that end together are not") {
  Made made;
  made.choices = {{"mass", {"m0"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  made.steps = {7e-4, 3.5e-4, 1.75e-4};
  StudyResults results = made.results();
  const auto told = [&](double duration) {
    for (CaseRecord& record : results.cases)
      record.steps = static_cast<long long>(duration / record.axes[1].second.get<double>() * (1 + 1e-12));
    const Choices choices(results);
    return Evidence(choices).warnings();
  };
  CHECK(told(0.7).empty());
  REQUIRE(told(0.6001).size() == 1);
  CHECK(told(0.6001).front() ==
        "Steps that do not divide the duration end the runs at 0.5999 to 0.600075 s: values at the end are of these.");
}

TEST_CASE("asks: one rigid impact at the same instant with each step tells nothing of the step") {
  Made made;
  made.choices = {{"mass", {"m0"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  made.error = 1e-4;
  const auto passes = [&](double apart, bool springs) {
    StudyResults results = made.results();
    for (std::size_t k = 0; k < results.cases.size(); ++k) {
      results.cases[k].measures.emplace_back("impacts", 1.0);
      results.cases[k].measures.emplace_back("first_impact", 0.496 + apart * static_cast<double>(k));
      if (springs) results.cases[k].measures.emplace_back("contact_steps", 40.0);
    }
    return answer_of(results, {{"limit", "impulse"}, {"below", 1.1}}).passes;
  };
  CHECK(passes(0, false) == Verdict::open);
  CHECK(passes(-1e-5, false) == Verdict::yes);
  CHECK(passes(0, true) == Verdict::yes);
}

TEST_CASE("asks: a step that moves by little casts no doubt on the mesh, and what leaves more open is told") {
  const std::vector<double> steps = {4e-3, 2e-3, 1e-3, 5e-4};
  const auto kept = [&](double of_step) {
    const StudyResults results = synthetic::full_factorial(
        {{"mass", {"m0"}}, {"elements", {"8", "16"}}}, steps,
        [&](const std::vector<std::size_t>& at, double h) {
          const auto halvings = static_cast<double>(std::find(steps.begin(), steps.end(), h) - steps.begin());
          return 1 + (at[1] == 0 ? 0.02 : 0.01) + of_step * halvings * halvings;
        },
        "impulse");
    return answer_of(results, {{"limit", "impulse"}, {"below", 1.06}});
  };
  // The mesh may leave 0.03, the step ten times what it moves by.
  CHECK(kept(1e-6).passes == Verdict::yes);
  const Answered much = kept(2e-3);
  INFO(much.sentence);
  CHECK(much.passes == Verdict::open);
  CHECK(much.reason == "it still rises with the step");
}

TEST_CASE("asks: one draw of a random load tells no value, two or an interval of its own do") {
  Made made;
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  made.scatter = made.error = 0.01;
  const Json ask = {{"limit", "impulse"}, {"below", 2}};
  const auto told = [&](const std::vector<std::string>& seeds, bool psd, bool parts) {
    made.choices = {{"mass", {"m0"}}, {seed_axis, seeds}};
    StudyResults results = made.results();
    if (psd) results.study["scene"]["load"] = Json::array({{{"force", {{"psd", {{"formula", "1"}}}}}}});
    if (parts)
      for (CaseRecord& record : results.cases) record.measures.emplace_back("confidence.impulse", 0.02);
    return answer_of(results, ask);
  };
  const Answered one = told({"1"}, true, false);
  INFO(one.sentence);
  CHECK(one.passes == Verdict::open);
  CHECK(one.reason == "one seed: what other draws leave is not known");
  CHECK(told({"1"}, false, false).passes == Verdict::yes);
  CHECK(told({"1"}, true, true).passes == Verdict::yes);
  CHECK(told({"1", "2"}, true, false).passes == Verdict::yes);
}

TEST_CASE("asks: what draws move by chance from step to step is no trend, what moves them all is") {
  Made made;
  made.choices = {{"mass", {"m0"}}, {seed_axis, {"1", "2", "3", "4", "5", "6", "7", "8"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  const auto trends = [&] {
    int count = 0;
    for (made.first_seed = 1; made.first_seed <= 40; ++made.first_seed) {
      const std::string reason = answer_of(made.results(), {{"value", "impulse"}}).rows.front().reason;
      count += reason.find("with the step") != std::string::npos;
    }
    return count;
  };
  made.chance = 0.1;
  CHECK(trends() <= 8);  // two moves are looked at, each beyond its interval in one of twenty
  made.chance = 0;
  made.scatter = 0.1;
  made.error = 0.2;
  made.order = 0.05;
  CHECK(trends() == 40);
}

TEST_CASE("asks: what two sizes leave is no doubt where draws leave more") {
  Made made;
  made.choices = {{"mass", {"m0"}}, {seed_axis, {"1", "2", "3", "4", "5", "6"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  made.steps = {4e-3, 2e-3};
  made.error = 0.02;
  const auto doubt = [&](double scatter) {
    made.scatter = scatter;
    return answer_of(made.results(), {{"value", "impulse"}}).rows.front().reason;
  };
  CHECK(doubt(0.2).empty());
  CHECK(doubt(0.002) == "it is known by two steps alone");
}

TEST_CASE("asks: what differs ten times at every size differs, though neither settles, unless it falls to zero") {
  const auto verdict = [](const std::vector<double>& first, const std::vector<double>& second) {
    const std::vector<double> steps = {4e-3, 2e-3, 1e-3, 5e-4};
    const StudyResults results = synthetic::full_factorial(
        {{"time", {"t0", "t1"}}}, steps,
        [&](const std::vector<std::size_t>& at, double h) {
          const auto k = static_cast<std::size_t>(std::find(steps.begin(), steps.end(), h) - steps.begin());
          return (at[0] == 0 ? first : second)[k];
        },
        "largest_step_gain");
    return answer_of(results, {{"effect", "time"}, {"on", "largest_step_gain"}, {"from", 0.01}}).passes;
  };
  const std::vector<double> wanders = {0.1, 5, 0.2, 3}, none = {1e-15, 2e-15, 1e-15, 2e-15};
  CHECK(verdict(wanders, none) == Verdict::yes);
  CHECK(verdict(none, wanders) == Verdict::yes);
  // A crossing at one size is no difference of all.
  CHECK(verdict(wanders, {0.001, 0.3, 0.001, 0.001}) == Verdict::open);
  // Both have the limit zero.
  CHECK(verdict({0.4, 0.08, 0.03, 0.005}, none) != Verdict::yes);
}

TEST_CASE("asks: the order of three sizes alone may be chance, that of four is confirmed") {
  Made made;
  made.choices = {{"mass", {"m0"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  made.error = 0.4;
  const auto below = [&](const std::vector<double>& steps, double bound) {
    made.steps = steps;
    return answer_of(made.results(), {{"limit", "impulse"}, {"below", bound}});
  };
  // 1.4, 1.2, 1.1: u = 0.125 decides 0.375 away.
  const Answered near = below({4e-3, 2e-3, 1e-3}, 1.4);
  INFO(near.sentence);
  CHECK(near.passes == Verdict::open);
  CHECK(near.reason == "it is known by three steps alone");
  CHECK(below({4e-3, 2e-3, 1e-3}, 1.5).passes == Verdict::yes);
  CHECK(below({8e-3, 4e-3, 2e-3, 1e-3}, 1.2).passes == Verdict::yes);
}

TEST_CASE("asks: of rigid impacts, or where their number changes, three values are known to their range") {
  // 1.4, 1.2, 1.1.
  Made made;
  made.choices = {{"mass", {"m0"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  made.error = 0.4;
  made.steps = {4e-3, 2e-3, 1e-3};
  const StudyResults results = made.results();
  const auto u = [&](const std::vector<double>& impacts, bool springs) {
    StudyResults with = results;
    for (std::size_t k = 0; k < with.cases.size(); ++k) {
      with.cases[k].measures.emplace_back("impacts", impacts[k]);
      if (springs) with.cases[k].measures.emplace_back(contact_steps_measure, 100);
    }
    const Answered answered = answer_of(with, {{"value", "impulse"}});
    return *answered.rows.front().high - *answered.rows.front().value;
  };
  CHECK(u({3, 3, 3}, true) == Approx(0.125));
  CHECK(u({0, 0, 0}, false) == Approx(0.125));
  CHECK(u({3, 3, 3}, false) == Approx(0.3));
  CHECK(u({3, 4, 4}, true) == Approx(0.3));
}

TEST_CASE("asks: a value that two steps tell is open, one of four is known") {
  Made made;
  made.choices = {{"mass", {"m0"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  made.error = 0.1;
  const Json value = {{"value", "impulse"}};
  CHECK(answer_of(made.results(), value).passes == Verdict::yes);
  made.steps = {4e-3, 2e-3};
  const Answered two = answer_of(made.results(), value);
  INFO(two.sentence);
  CHECK(two.passes == Verdict::open);
  CHECK(two.rows.front().verdict == "open");
  CHECK(two.sentence.ends_with("; it is known by two steps alone."));
}

TEST_CASE("asks: choices that never differ alone have no effect, no rank and no threshold") {
  Made made;
  made.choices = {{"time", {"s0", "s1"}}, {"time.restitution", {"0.5", "0.8"}}};
  made.truth = [](const std::vector<std::size_t>& at) { return 1.0 + static_cast<double>(at[0]); };
  made.error = 1e-3;
  StudyResults results = made.results();
  std::erase_if(results.cases,
                [](const CaseRecord& one) { return (one.axes[0].second == "s0") != (one.axes[1].second == "0.5"); });
  for (CaseRecord& record : results.cases) record.axes[1].second = std::stod(record.axes[1].second.get<std::string>());
  for (const Json& ask : {Json{{"effect", "time.restitution"}, {"on", "impulse"}, {"within", 0.01}},
                          Json{{"rank", "impulse"}, {"over", "time.restitution"}}}) {
    const Answered answered = answer_of(results, ask);
    INFO(answered.sentence);
    CHECK(answered.passes == Verdict::open);
    CHECK(answered.sentence.find("never differs alone") != std::string::npos);
  }
  // A role's levels are told with what both have of contact.
  const Answered effect = answer_of(results, {{"effect", "time"}, {"on", "impulse"}, {"from", 0.05}});
  INFO(effect.sentence);
  CHECK(effect.rows.front().level == "s1, e = 0.8 against s0, e = ½");
}

TEST_CASE("asks: thresholds and limits speak alike of seeds, and of levels that are open") {
  Made made;
  made.choices = {{"stops.upper", {"1", "2", "3", "4"}}, {std::string(seed_axis), {"1", "2", "3", "4", "5", "6"}}};
  made.error = 1e-6;
  made.truth = [](const std::vector<std::size_t>& at) {
    // At the second level one seed is beyond, and the mean is not.
    return at[0] == 1 ? (at[1] == 3 ? 4.0 : 0.5) : static_cast<double>(at[0] < 1 ? 1 : 5);
  };
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases) record.axes[0].second = std::stod(record.axes[0].second.get<std::string>());
  const Answered threshold = answer_of(results, {{"threshold", "impulse"}, {"below", 3.0}, {"along", "stops.upper"}}),
                 limit = answer_of(results, {{"limit", "impulse"}, {"below", 3.0}});
  INFO(threshold.sentence << "\n" << limit.sentence);
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(threshold.rows[k].verdict == limit.rows[k].verdict);
    CHECK(threshold.rows[k].reason == limit.rows[k].reason);
  }
  CHECK(threshold.rows[1].reason == "1 of 6 seeds is beyond");
  CHECK(threshold.sentence.starts_with("Between 1 and 2:"));
}

TEST_CASE("asks: a threshold says which levels beyond it are open, and passes nothing then") {
  Made made;
  made.choices = {{"stops.upper", {"1", "2", "3", "4"}}};
  made.truth = [](const std::vector<std::size_t>& at) { return at[0] == 0 ? 1.0 : 2.0; };
  made.error = 1e-3;
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases) {
    record.axes[0].second = std::stod(record.axes[0].second.get<std::string>());
    // At the last level the limit is the value that is asked for.
    const double h = axis(record, "step").number().value();
    if (record.axes[0].second == 4.0) record.measures.front().second = 1.5 * (1 + 20 * h);
  }
  const Answered answered = answer_of(results, {{"threshold", "impulse"}, {"above", 1.5}, {"along", "stops.upper"}});
  INFO(answered.sentence);
  CHECK(answered.passes == Verdict::open);
  CHECK(answered.sentence.find("open at 1 of 4 levels") != std::string::npos);
}

TEST_CASE("asks: a measure that is the value on every level is that, not below it") {
  Made made;
  made.choices = {{"mass", {"m0", "m1"}}, {"stops.upper", {"1", "2"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 0.0; };
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases) record.axes[1].second = std::stod(record.axes[1].second.get<std::string>());
  // Others have shares.
  results.cases.front().measures.front().second = -0.25;
  const Answered answered = answer_of(results, {{"threshold", "impulse"}, {"is", 0.0}, {"along", "stops.upper"}});
  INFO(answered.sentence);
  CHECK(answered.sentence.find("always below 0") == std::string::npos);
}

TEST_CASE("asks: of a value that levels keep on a side, or equal, no series is said to have it") {
  Made made;
  made.choices = {{"mass", {"m0", "m1"}}, {"stops.upper", {"1", "2", "3"}}};
  const auto answered = [&](const std::function<double(const std::vector<std::size_t>&)>& truth, double is) {
    made.truth = truth;
    StudyResults results = made.results();
    for (CaseRecord& record : results.cases)
      record.axes[1].second = std::stod(record.axes[1].second.get<std::string>());
    return answer_of(results, {{"threshold", "impulse"}, {"is", is}, {"along", "stops.upper"}});
  };
  const auto says = [](const Answered& one, const std::string& words) {
    INFO(one.sentence);
    CHECK(one.sentence.find(words) != std::string::npos);
  };
  // One above, one below, everywhere.
  const Answered sides = answered([](const auto& at) { return at[0] == 0 ? 3.5 : 1.5; }, 2);
  says(sides, "is always above 2 N s with ");
  says(sides, "always below it with ");
  // One falls to the value and keeps it; the other stays above it.
  const Answered kept = answered([](const auto& at) { return at[0] == 0 && at[1] > 0 ? 2.0 : 3.5; }, 2);
  says(kept, "is 2 N s from there, and larger before");
  says(kept, "; always above with ");
  CHECK(kept.sentence.find("smaller") == std::string::npos);
}

TEST_CASE("asks: an effect of numbers is a share of the lower level, in whatever order they are listed") {
  std::set<std::string> sentences;
  for (const bool turned : {false, true}) {
    Made made;
    made.choices = {{"stops.upper", turned ? std::vector<std::string>{"2", "1"} : std::vector<std::string>{"1", "2"}}};
    made.truth = [=](const std::vector<std::size_t>& at) { return (at[0] == 0) == turned ? 1.45 : 1.0; };
    made.error = 1e-4;
    StudyResults results = made.results();
    for (CaseRecord& record : results.cases)
      record.axes[0].second = std::stod(record.axes[0].second.get<std::string>());
    const Answered answered = answer_of(results, {{"effect", "stops.upper"}, {"on", "impulse"}, {"from", 0.4}});
    CHECK(answered.passes == Verdict::yes);
    sentences.insert(answered.sentence);
  }
  CHECK(sentences.size() == 1);
}

TEST_CASE("asks: shares of both signs are said with what they are shares of") {
  // The pair that decides is another with each mass: the first and the second, the first and the third.
  Made made;
  made.choices = {{"time", {"t0", "t1", "t2"}}, {"mass", {"m0", "m1"}}};
  const double values[3][2] = {{1, 1}, {1.5, 1}, {1.2, 0.5}};
  made.truth = [&](const std::vector<std::size_t>& at) { return values[at[0]][at[1]]; };
  const auto sentence = [&] {
    return answer_of(made.results(), {{"effect", "time"}, {"on", "impulse"}, {"from", 0.05}}).sentence;
  };
  CHECK_THAT(sentence(), Catch::Contains("% of the level listed first"));
  made.choices[0] = {"time.beta", {"0.25", "0.5", "0.75"}};
  made.choices.push_back({"time", {"t0"}});
  CHECK_THAT(answer_of(made.results(), {{"effect", "time.beta"}, {"on", "impulse"}, {"from", 0.05}}).sentence,
             Catch::Contains("% of the lower level"));
}

TEST_CASE("asks: contacts that no step resolves keep no limit and break none") {
  Made made;
  made.choices = {{"mass", {"m0"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  made.error = 1e-3;
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases) record.measures.emplace_back(contact_steps_measure, 2.5);
  for (const double below : {0.5, 1.5}) {
    const Answered open = answer_of(results, {{"limit", "impulse"}, {"below", below}});
    INFO(open.sentence);
    CHECK(open.passes == Verdict::open);
    CHECK(open.reason == "contact is not resolved by any step");
  }
  // One that does is enough: what the others leave is in the interval.
  results.cases.back().measures.back().second = 50;
  CHECK(answer_of(results, {{"limit", "impulse"}, {"below", 1.5}}).passes == Verdict::yes);
}

TEST_CASE("asks: a stop that is never touched has its line, and its reason") {
  Made made;
  made.choices = {{"mass", {"m0"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  made.error = 1e-3;
  made.measure = "mean_force[p1]";
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases) {
    record.measures.emplace_back("contact_time[p1]", 0.5);
    record.measures.emplace_back("contact_time[p2]", 0.0);
  }
  const Answered answered = answer_of(results, {{"value", "mean_force"}});
  const auto row =
      std::find_if(answered.rows.begin(), answered.rows.end(), [](const VerdictRow& one) { return one.stop == "p2"; });
  REQUIRE(row != answered.rows.end());
  CHECK(row->reason.find("the stop is never touched") != std::string::npos);
  // It keeps below any limit, and comes last.
  const Answered below = answer_of(results, {{"limit", "mean_force"}, {"below", 2.0}}),
                 beyond = answer_of(results, {{"limit", "mean_force"}, {"below", 0.5}}),
                 above = answer_of(results, {{"limit", "mean_force"}, {"above", 0.5}}),
                 ranked = answer_of(results, {{"rank", "mean_force"}, {"over", "stops"}});
  CHECK(below.passes == Verdict::yes);
  CHECK(beyond.passes == Verdict::no);
  CHECK(above.passes == Verdict::open);
  INFO(ranked.sentence);
  CHECK(ranked.passes == Verdict::yes);
  CHECK(ranked.sentence.find("nothing touches p2") != std::string::npos);
  CHECK(ranked.rows.back().verdict == "last");
}

TEST_CASE("asks: a stop without a surface has no line of what runs along one, touched or not") {
  Made made;
  made.choices = {{"mass", {"m0"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 0.5; };
  made.error = 1e-3;
  made.measure = "wear_power[plate]";
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases) {
    record.measures.emplace_back("contact_time[plate]", 0.5);
    record.measures.emplace_back("contact_time[end]", 0.0);
  }
  const Answered answered = answer_of(results, {{"limit", "wear_power"}, {"below", 1}});
  CHECK(answered.passes == Verdict::yes);
  CHECK(std::none_of(answered.rows.begin(), answered.rows.end(), [](const auto& row) { return row.stop == "end"; }));
}

TEST_CASE("asks: of several meshes one alone with a value tells neither yes nor no") {
  Made made;
  made.choices = {{"elements", {"6", "12"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 0.5; };
  made.error = 1e-3;
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases) record.axes[0].second = std::stod(record.axes[0].second.get<std::string>());
  const Json ask = {{"limit", "impulse"}, {"below", 1}};
  CHECK(answer_of(results, ask).passes == Verdict::yes);
  for (CaseRecord& record : results.cases)
    if (record.axes[0].second == 12) record.measures.clear();
  const Answered lost = answer_of(results, ask);
  CHECK(lost.passes == Verdict::open);
  CHECK(lost.rows.front().reason.find("one mesh alone has a value") != std::string::npos);
}

TEST_CASE("asks: a count that has no limit is no value, whatever was counted") {
  Made made;
  made.choices = {{"mass", {"m0"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 38; };
  made.measure = "impacts";
  StudyResults results = made.results();
  const Json ask = {{"limit", "impacts"}, {"below", 60}};
  CHECK(answer_of(results, ask).passes == Verdict::yes);
  // The finest alone says so: what coarser steps counted is no limit either.
  const Choices before(results);
  auto& finest = *std::min_element(results.cases.begin(), results.cases.end(),
                                   [&](const auto& a, const auto& b) { return before.finer(a, b); });
  finest.left_out.emplace_back("impacts", no_count);
  CHECK(answer_of(results, ask).passes == Verdict::open);
  for (const bool all : {false, true}) {
    if (all)
      for (CaseRecord& record : results.cases) record.left_out.emplace_back("impacts", no_count);
    CHECK(answer_of(results, ask).rows.front().reason.find("without number") != std::string::npos);
    CHECK(answers::limits_of(Choices(results), "impacts", false, all_cases(results)).with_limit().empty());
  }
}

TEST_CASE("asks: what is held open beyond a limit is not said to hold it") {
  // 2, 1.5 and 1.25 of two steps: u is the last difference, three times that reach the limit.
  Made made;
  made.choices = {{"mass", {"m0"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  made.error = 1;
  made.steps = {2e-3, 1e-3};
  const Answered answered = answer_of(made.results(), {{"limit", "impulse"}, {"below", 0.9}});
  CHECK(answered.passes == Verdict::open);
  CHECK(answered.rows.front().reason.find("lies within") == std::string::npos);
  CHECK(answered.rows.front().reason.find("two steps alone") != std::string::npos);
}

TEST_CASE("asks: what is refused throughout is left out of a limit by name") {
  Made made;
  made.choices = {{"mass", {"m0", "m1"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  made.error = 1e-3;
  StudyResults results = made.results();
  double number = 3;
  for (CaseRecord& record : results.cases)
    if (record.axes[0].second == "m1") {
      record.status = Status::refused;
      record.measures.clear();
      record.reasons = {said("step {} is too large", number++)};
    }
  const Answered answered = answer_of(results, {{"limit", "impulse"}, {"below", 2.0}});
  INFO(answered.sentence);
  CHECK(answered.passes == Verdict::yes);
  // Numbers are those of the first.
  CHECK(answered.aside.front() == "Left out: 4 refused, the first: step 3 is too large.");
}

TEST_CASE("asks: a limit is said with all digits that were given") {
  Made made;
  made.choices = {{"mass", {"m0"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  made.error = 1e-7;
  for (const double below : {1.0001, 1.00005, 1.0000211}) {
    const Answered answered = answer_of(made.results(), {{"limit", "impulse"}, {"below", below}});
    INFO(answered.sentence);
    CHECK(answered.passes == Verdict::yes);
    CHECK(answered.sentence.find(fmt::format("below {} ", below)) != std::string::npos);
  }
}

TEST_CASE("asks: what holds in one range of an axis has both its ends") {
  Made made;
  made.choices = {{"stops.upper", {"1", "2", "3", "4", "5", "6", "7"}}};
  made.error = 1e-6;
  const auto answered = [&](const std::vector<double>& values) {
    made.truth = [values](const std::vector<std::size_t>& at) { return values[at[0]]; };
    StudyResults results = made.results();
    for (CaseRecord& record : results.cases)
      record.axes[0].second = std::stod(record.axes[0].second.get<std::string>());
    return answer_of(results, {{"threshold", "impulse"}, {"above", 1.5}, {"along", "stops.upper"}});
  };
  const auto brackets = [](const Answered& of) {
    return std::count_if(of.rows.begin(), of.rows.end(),
                         [](const VerdictRow& row) { return row.verdict == "not monotone"; });
  };
  const Answered one = answered({1, 1, 2, 2, 2, 1, 1}), but_one = answered({2, 2, 1, 1, 2, 2, 2}),
                 several = answered({1, 2, 2, 1, 1, 2, 2});
  INFO(one.sentence << "\n" << but_one.sentence << "\n" << several.sentence);
  CHECK(brackets(one) == 2);
  CHECK(one.sentence.find("is above 1.5 N s in one range of") != std::string::npos);
  CHECK(one.sentence.find("from 2–3 to 5–6.") != std::string::npos);
  CHECK(but_one.sentence.find("is not above 1.5 N s in one range of") != std::string::npos);
  CHECK(brackets(several) == 3);
  CHECK(several.sentence.find("in several ranges") != std::string::npos);
}

TEST_CASE("asks: seeds that know their own intervals fall with the root of their number") {
  Made made;
  made.choices = {{seed_axis, {"1", "2", "3"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases) record.measures.emplace_back("confidence.impulse", 0.2);
  const Answered answered = answer_of(results, {{"enough", "impulse"}, {"within", 0.03}});
  const auto would = std::find_if(answered.rows.begin(), answered.rows.end(),
                                  [](const VerdictRow& one) { return one.verdict == "seeds that would do"; });
  REQUIRE(would != answered.rows.end());
  // 0.2/√n ≤ 0.03.
  CHECK(*would->value == std::ceil(std::pow(0.2 / 0.03, 2)));
}

TEST_CASE("asks: few seeds that contradict their own intervals are known by their scatter") {
  const auto u_of = [](const std::vector<double>& values) {
    Made made;
    made.choices = {{seed_axis, {"1", "2", "3"}}};
    made.truth = [&](const std::vector<std::size_t>& at) { return values[at[0]]; };
    StudyResults results = made.results();
    for (CaseRecord& record : results.cases) record.measures.emplace_back("confidence.impulse", 0.1);
    const Answered answered = answer_of(results, {{"value", "impulse"}});
    return *answered.rows.front().high - *answered.rows.front().value;
  };
  CHECK(u_of({1, 1.05, 0.95}) == Approx(0.1 / std::sqrt(3.0)));
  // Student's t of three draws, 4.303 s/√3.
  CHECK(u_of({1.3, 0.85, 0.63}) > 0.8);
}

TEST_CASE("asks: what a step may still leave is no more of what draws leave") {
  // Draws that scatter by a tenth, a step that leaves a hundredth of that and is known by three sizes alone.
  Made made;
  made.choices = {{seed_axis, {}}, {"mass", {"m0", "m1"}}};
  for (int seed = 1; seed <= 8; ++seed) made.choices[0].levels.push_back(std::to_string(seed));
  made.steps = {4e-3, 2e-3, 1e-3};
  made.truth = [](const std::vector<std::size_t>& at) { return at[1] == 0 ? 1.0 : 1.6; };
  made.scatter = 0.1;
  made.error = 2e-3;
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases) record.measures.emplace_back("confidence.impulse", 0.1);
  const Answered ranked = answer_of(results, {{"rank", "impulse"}, {"over", "mass"}}),
                 limit = answer_of(results, {{"limit", "impulse"}, {"below", 2.0}}),
                 enough = answer_of(results, {{"enough", "impulse"}, {"within", 0.2}});
  INFO(ranked.sentence << "\n" << limit.sentence << "\n" << enough.sentence);
  CHECK(ranked.passes == Verdict::yes);
  CHECK(limit.passes == Verdict::yes);
  CHECK(enough.passes == Verdict::yes);
}

TEST_CASE("asks: what is the same share of every draw is known, however the draws scatter") {
  Made made;
  made.choices = {{seed_axis, {"1", "2", "3", "4", "5", "6"}}, {"mass", {"m0", "m1"}}};
  made.truth = [](const std::vector<std::size_t>& at) { return at[1] == 0 ? 1.0 : 5.0; };
  made.scatter = 0.2;
  made.error = 1e-6;
  const StudyResults results = made.results();
  const Answered answered = answer_of(results, {{"effect", "mass"}, {"on", "impulse"}, {"from", 3.95}});
  INFO(answered.sentence);
  CHECK(answered.passes == Verdict::yes);
  const VerdictRow& row = answered.rows.front();
  CHECK(*row.value == Approx(400));
  CHECK(*row.high - *row.low < 1e-3);
}

TEST_CASE("asks: a mean over a window keeps to a limit by its interval, an extreme with each of its draws") {
  for (const bool mean : {true, false}) {
    Made made;
    made.choices = {{seed_axis, {}}};
    for (int seed = 1; seed <= 30; ++seed) made.choices[0].levels.push_back(std::to_string(seed));
    made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
    made.scatter = 0.1;
    made.measure = mean ? "window_displacement_rms[gap]" : "window_displacement_max[gap]";
    const StudyResults results = made.results();
    // Between the mean of the draws and the largest.
    const Answered answered = answer_of(results, {{"limit", made.measure}, {"below", 1.12}});
    INFO(answered.sentence);
    CHECK(answered.passes == (mean ? Verdict::yes : Verdict::no));
  }
}

TEST_CASE("asks: pairs of schemes agree in a restitution that all of them have") {
  Made made;
  made.choices = {{"time", {"s0", "s1"}}, {"time.restitution", {"0.2", "0.6"}}};
  made.truth = [](const std::vector<std::size_t>& at) { return 1.2 + 0.4 * static_cast<double>(at[1]); };
  made.error = 1e-5;
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases) record.axes[1].second = std::stod(record.axes[1].second.get<std::string>());
  const Answered alike = answer_of(results, {{"effect", "time"}, {"on", "impulse"}, {"within", 0.01}});
  INFO(alike.sentence);
  CHECK(alike.passes == Verdict::yes);
  CHECK(answer_of(results, {{"effect", "time.restitution"}, {"on", "impulse"}, {"from", 0.3}}).passes == Verdict::yes);
}

TEST_CASE("asks: friction that sticks and slips errs as impacts do, and its share by a step for each change") {
  Made made;
  made.choices = {{"mass", {"m0"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 0.7; };
  made.measure = "stick_share[floor]";
  made.error = 1e-9;
  StudyResults results = made.results();
  results.study["duration"] = 1.0;
  const auto row_of = [&] { return answer_of(results, {{"value", "stick_share"}}).rows.front(); };
  for (CaseRecord& record : results.cases) record.measures.emplace_back("stick_slip_changes[floor]", 3.0);
  const VerdictRow row = row_of();
  // Three changes in a second, each known to the finest step.
  CHECK(*row.high - *row.value >= 2.99 * made.steps.back());
  Cases cases;
  for (const CaseRecord& record : results.cases) cases.push_back(&record);
  CHECK(answers::errors_of(cases) == Errors::saw_toothed);
}

TEST_CASE("asks: a window that holds a whole repetition of the load is not shortened") {
  Made made;
  made.choices = {{seed_axis, {"1", "2", "3"}}};
  made.truth = [](const std::vector<std::size_t>&) { return 1.0; };
  made.error = 1e-5;
  made.scatter = 1e-6;
  StudyResults results = made.results();
  results.study["window"] = {{"from", 0}, {"to", 20}};
  const auto windows = [&](double period) {
    results.study["scene"]["load"] = Json::array({{{"force", {{"psd", {{"lines", period}, {"from", 0}, {"to", 1}}}}}}});
    std::vector<double> out;
    for (const VerdictRow& row : answer_of(results, {{"enough", "impulse"}, {"within", 0.1}}).rows)
      if (row.verdict == "window that would do") out.push_back(*row.value);
    return out;
  };
  CHECK(windows(20).empty());
  // Nor one of which little is missing: what it holds scatters less than its length tells.
  CHECK(windows(20.5).empty());
  CHECK(windows(39).empty());
  // Of others no shorter one is told than a tenth.
  for (const double window : windows(200)) CHECK(window >= 2);
}

TEST_CASE("asks: a difference that is zero to the last bit is known") {
  StudyResults results = two_methods({1.1, 1.05, 1.025, 1.0125}, {1.1, 1.05, 1.025, 1.0125});
  for (CaseRecord& record : results.cases) record.measures.emplace_back("confidence.impulse", 0.2);
  const Json within = {{"effect", "mass"}, {"on", "impulse"}, {"within", 0.05}};
  CHECK(answer_of(results, within).passes == Verdict::yes);
  // Draws of their own leave theirs.
  for (CaseRecord& record : results.cases)
    if (record.axes[0].second == "m1") record.measures.back().second = 0.21;
  CHECK(answer_of(results, within).passes == Verdict::open);
}

TEST_CASE("asks: where the mesh alone leaves more than asked the answer is no") {
  Made made;
  made.choices = {{"elements", {"8", "16", "32"}}};
  made.truth = [](const std::vector<std::size_t>& at) { return 1 + std::pow(0.5, static_cast<double>(at[0])); };
  made.error = 1e-3;
  StudyResults results = made.results();
  for (CaseRecord& record : results.cases) record.axes[0].second = std::stoi(record.axes[0].second.get<std::string>());
  const Answered answered = answer_of(results, {{"enough", "impulse"}, {"within", 0.05}});
  INFO(answered.sentence);
  CHECK(answered.passes == Verdict::no);
  CHECK(answered.sentence.find("the mesh alone leaves") != std::string::npos);
}

TEST_CASE("asks: of what has no finished case nothing is told, in every kind") {
  for (const KindPointer& kind : kinds()) {
    for (const Verb* verb : verbs()) {
      StudyResults results;
      results.kind = kind->format.name;
      results.columns = {"mass", "step"};
      results.study = {{"observe", {"impulse"}}};
      Json ask = {{"below", 1}, {"above", 0}, {"within", 0.1}, {"over", "mass"}, {"along", "step"}, {"on", "impulse"}};
      ask[verb->name] = verb->name == std::string("points") ? Json::array({"fold"})
                        : verb->name == std::string("runs") ? Json(true)
                                                            : Json("impulse");
      results.study["ask"] = {ask};
      INFO(kind->format.name << " " << verb->name);
      const bool own = std::any_of(kind->format.verbs.begin(), kind->format.verbs.end(),
                                   [&](const auto& one) { return one == std::string(verb->name); });
      if (!own && !verb->answer) continue;
      const AnalysedResults analysed(std::move(results));
      for (const auto& [asked, answered] : analysed.asked.all) {
        CHECK_FALSE(answered.sentence.empty());
        CHECK(answered.passes != Verdict::no);
      }
    }
  }
}

TEST_CASE("asks: an order that is not told turns nothing round") {
  // m1 is larger with t1, but within what their steps leave; of t2 it stands alone.
  Made made;
  made.choices = {{"mass", {"m0", "m1"}}, {"time", {"t0", "t1", "t2"}}};
  made.truth = [](const std::vector<std::size_t>& at) {
    return at[1] == 0 ? 2.0 - static_cast<double>(at[0]) : 1.0 + 1e-4 * static_cast<double>(at[0]);
  };
  made.error = 0.01;
  StudyResults results = made.results();
  std::erase_if(results.cases,
                [](const CaseRecord& one) { return one.axes[0].second == "m0" && one.axes[1].second == "t2"; });
  // Beside the same error its difference tells it; beside one of its own, which wanders, nothing does.
  CHECK(answer_of(results, {{"rank", "impulse"}, {"over", "mass"}}).verdict == "turned round");
  for (std::size_t k = 0; k < results.cases.size(); ++k)
    if (results.cases[k].axes[0].second == "m1") results.cases[k].measures[0].second *= k % 2 == 0 ? 1.001 : 0.999;
  const Answered answered = answer_of(results, {{"rank", "impulse"}, {"over", "mass"}});
  INFO(answered.sentence);
  CHECK(answered.verdict != "turned round");
  CHECK(answered.passes != Verdict::no);
}

TEST_CASE("asks: the interval of a peak holds what two steps miss between them") {
  // A half sine of 100 N whose top lies a quarter of the finest step beside an instant that all steps share.
  const double top = 100;
  const std::vector<double> counts = {10, 20, 40, 80};  // steps in half a period
  const std::vector<double> steps = {8e-3, 4e-3, 2e-3, 1e-3};
  StudyResults results = synthetic::full_factorial(
      {{"mass", {"m0"}}}, steps,
      [&](const std::vector<std::size_t>&, double) { return top * std::cos(3.14159 / counts.back() / 4); },
      "peak_force[wall]");
  for (std::size_t k = 0; k < results.cases.size(); ++k)
    results.cases[k].measures.emplace_back("contact_steps", counts[k]);
  const VerdictRow row = answer_of(results, {{"value", "peak_force"}}).rows.front();
  REQUIRE(row.high);
  CHECK(*row.high > top);
  CHECK(*row.high < 1.0002 * top);
  // A mean is no peak.
  for (CaseRecord& record : results.cases) record.measures.front().first = "mean_force[wall]";
  CHECK(*answer_of(results, {{"value", "mean_force"}}).rows.front().high < top);
}

TEST_CASE("tables of limits: a single step leaves no interval and no verdict") {
  Made made;
  made.choices = {{"mass", {"m0", "m1"}}};
  made.truth = [](const std::vector<std::size_t>& at) { return at[0] == 0 ? 1.0 : 2.0; };
  for (const bool one : {true, false}) {
    INFO(one);
    if (one) made.steps = {1e-3};
    const StudyResults results = made.results();
    const Choices study(results);
    const Table limits = answers::limits_table(study, {"impulse"});
    const TableReader rows(limits);
    REQUIRE(rows.size() == 2);
    for (const char* column : {"u", "low", "high"}) CHECK(rows.number(0, column).has_value() == !one);
    const Table differences = answers::differences_table(study, {"impulse"});
    REQUIRE(TableReader(differences).size() == 1);
    CHECK(TableReader(differences).text(0, "verdict") == (one ? "open" : "matters"));
    made.steps = {4e-3, 2e-3, 1e-3, 5e-4};
  }
}

TEST_CASE("asks: what stays within the motion of every step does not grow without bound") {
  StudyResults results = synthetic::full_factorial(
      {{"mass", {"m0"}}}, {4e-3, 2e-3, 1e-3}, [](const std::vector<std::size_t>&, double h) { return -0.001 / h; },
      "tip_displacement_end");
  const Json ask = {{"value", "tip_displacement_end"}};
  const auto with_largest = [&](double largest) {
    for (CaseRecord& record : results.cases) {
      std::erase_if(record.measures, [](const auto& one) { return one.first == "largest_tip_displacement"; });
      record.measures.emplace_back("largest_tip_displacement", largest);
    }
    return answer_of(results, ask).rows.front();
  };
  CHECK(with_largest(0.5).reason == "grows without bound");
  const VerdictRow held = with_largest(1.2);
  CHECK(held.reason == "still falls with the step");
  CHECK((*held.low < *held.value && *held.value <= *held.high));
}
