// What a scene says of itself in the summary, in plans and in sentences is what its form declares, key by key.
#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <random>
#include <set>

#include "runners/report/html.hpp"
#include "runners/report/scene_sketch.hpp"
#include "runners/study/check_object.hpp"
#include "runners/study/declared_keys.hpp"

using namespace ricochet;

namespace scene_numbers_tests {

namespace {

/// Every field of a form and of all that it may become.
void each_field(const ObjectForm& form, const std::function<void(const Field&)>& see) {
  for (const Field& field : form.fields) {
    see(field);
    for (const auto* forms : {&field.nested, &field.listed, &field.given})
      for (const ObjectForm& one : *forms) each_field(one, see);
  }
  for (const Variant& variant : form.variants) each_field(variant.keys, see);
  for (const ObjectForm& way : form.ways) each_field(way, see);
}

/// A scene in which every key that may stand beside the others has a value of its own, and what is to be said of each.
/// Chance decides which of the forms an object takes.
class SceneMaker {
 public:
  explicit SceneMaker(unsigned seed) : chance_(seed) {}

  Json object(const ObjectForm& form, const std::string& of = "") {
    Json out = Json::object();
    add_keys(form, of, out);
    return out;
  }

  std::vector<std::string> expected;  ///< "L 0.1003 m"
  std::set<const Field*> met;

 private:
  bool toss() { return chance_() % 2 == 0; }
  template <class List>
  const auto& one_of(const List& list) {
    return list[chance_() % list.size()];
  }
  Json say(const Field& field, const std::string& of, const Json& value) {
    const std::string symbol = field.symbol.value_or(report::in_words(field.key())) + of;
    const std::string unit = field.spec.unit == "1" || !value.is_number() ? "" : " " + field.spec.unit;
    const std::string text = value.is_string()   ? value.get<std::string>()
                             : value.is_number() ? report::number_text(value.get<double>())
                                                 : value.dump();
    expected.push_back((symbol.empty() || field.key() == "name" ? "" : symbol + " ") + text +
                       (unit == " " ? "" : unit));
    return value;
  }
  double number() { return 0.1 + 0.0001 * ++count_; }  // within every range, in the digits that are shown
  std::string name() { return "n" + std::to_string(++count_); }

  void add_keys(const ObjectForm& form, const std::string& of, Json& out) {
    std::set<std::string> others;
    for (const Field& field : form.fields)
      if (!field.unless.empty()) others.insert(toss() ? field.key() : field.unless);
    for (const Field& field : form.fields) {
      if (others.count(field.key()) > 0) continue;
      met.insert(&field);
      out[field.key()] = value(field, of);
    }
    if (!form.ways.empty()) add_keys(one_of(form.ways), of, out);
    const Json::json_pointer place(form.discriminator);
    if (form.discriminator.empty() || !out.contains(place)) return;
    for (const Variant& one : form.variants)
      if (std::find(one.words.begin(), one.words.end(), out.at(place)) != one.words.end()) add_keys(one.keys, of, out);
  }

  Json scalar(const Field& field, const std::string& of) {
    using Type = ParameterSpec::Type;
    if (field.spec.type == Type::boolean) return say(field, of, !field.fallback->get<bool>());
    if (field.spec.type == Type::real) return say(field, of, number());
    if (field.spec.type == Type::word) {
      std::vector<std::string> words = field.spec.words;
      if (field.fallback) std::erase(words, *field.fallback);
      return words.empty() ? *field.fallback : say(field, of, one_of(words));
    }
    long long whole = static_cast<long long>(field.spec.range.high);
    if (field.spec.range.contains(200)) whole = 200 + static_cast<long long>(++count_);
    return say(field, of, whole);
  }

  Json value(const Field& field, const std::string& of) {
    using Form = Field::Form;
    switch (field.form) {
      case Form::scalar:
        if (!field.given.empty() && toss()) return object(field.given.front());
        return scalar(field, of);
      case Form::formula:
        if (!field.nested.empty() && toss()) return Json::array({object(field.nested.front())});
        if (!field.given.empty() && toss()) return object(field.given.front());
        return say(field, of, number());
      case Form::text:
        if (!field.given.empty() && toss()) return object(field.given.front());
        return say(field, of, name());
      case Form::place: {
        const double x = number();
        expected.push_back(report::number_text(x) + " m");
        return {{"x", x}};
      }
      case Form::places:
      case Form::numbers: {
        const std::size_t count = field.count == 0 ? 2 : field.count;
        Json list = Json::array();
        for (std::size_t i = 0; i < count; ++i) list.push_back(number());
        for (const Json& one : list) expected.push_back(report::number_text(one.get<double>()));
        return list;
      }
      case Form::words: {
        const std::string word = field.spec.words.empty() ? name() : field.spec.words.front();
        say(field, of, word);
        return Json::array({word});
      }
      case Form::named: {
        const std::string key = name(), text = name();
        expected.push_back(key + " " + text);
        return {{key, text}};
      }
      case Form::object: {
        if (!field.listed.empty() && toss()) return Json::array({object(field.listed.front())});
        if (field.given.empty() || toss()) return object(field.nested.front());
        const std::string body = name();
        return {{body, object(field.given.front(), " of " + body)}};
      }
      case Form::objects:
        return Json::array({object(field.nested.front())});
      case Form::bodies:
        return {{name(), object(field.nested.front())}};
      default:
        FAIL("no scene has " + field.key());
    }
    return nullptr;
  }

  std::mt19937 chance_;
  int count_ = 0;
};

}  // namespace

TEST_CASE("every key that a scene may have is said with its symbol, its value and its unit", "[report]") {
  std::set<const Field*> left;
  each_field(scene_form(), [&](const Field& field) { left.insert(&field); });
  CHECK(left.size() > 150);
  for (unsigned seed = 0; seed < 300 && !left.empty(); ++seed) {
    SceneMaker maker(seed);
    const Json scene = maker.object(scene_form());
    std::vector<Axis> axes;
    const Json study = {{"scene", check_object(scene_form(), scene, "/scene", axes)}};
    const std::string said = report::in_a_line(report::scene_numbers(study));
    INFO(scene.dump(1) << "\n" << said);
    for (const std::string& one : maker.expected) CHECK_THAT(said, Catch::Contains(one));
    for (const Field* field : maker.met) left.erase(field);
  }
  for (const Field* field : left) FAIL_CHECK("never set: " << field->key() << ", " << field->spec.text);
}

TEST_CASE("every number of a scene that may be an axis has words for a sentence", "[report]") {
  each_field(scene_form(), [](const Field& field) {
    const bool number = field.form == Field::Form::scalar && field.spec.type == ParameterSpec::Type::real;
    INFO(field.key() << ": " << field.spec.text);
    if (field.axis && (number || field.form == Field::Form::formula)) CHECK_FALSE(field.words.empty());
  });
}

TEST_CASE("what a scene says is left out where it is at its default, and a motion or force without amplitude") {
  const auto said = [](const std::string& scene) {
    return report::in_a_line(report::scene_numbers({{"scene", Json::parse(scene)}}));
  };
  const std::string oscillator = R"({"structure": {"type": "oscillator", "mass": 2, "stiffness": 0, "damping": 0,)";
  const std::string at_rest = oscillator + R"("force": {"amplitude": 0, "pulsation": 3, "phase": 1}},
    "stops": {"lower": "0", "upper": null, "at": "nodes"}, "support": {"amplitude": 0, "pulsation": 10, "phase": 0},
    "load": 0, "initial": {"displacement": "0", "velocity": 0, "projection": "none"}})";
  CHECK(said(at_rest) == "oscillator, m 2 kg, k 0 N/m, lower stop 0 m, stops at nodes");
  const std::string forced = oscillator + R"("force": {"amplitude": 1, "pulsation": [3, 4], "phase": 0}}})";
  CHECK(said(forced) == "oscillator, m 2 kg, k 0 N/m, F 1 N, ω of F 3 and 4 rad/s");
  // What this program does not know is left out, not guessed.
  const std::string unknown = R"json({"structure": {"type": "membrane", "mass": 2}, "load": "sin(t)"})json";
  CHECK(said(unknown) == "load sin(t)");
}

}  // namespace scene_numbers_tests
