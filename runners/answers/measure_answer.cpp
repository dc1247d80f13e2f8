#include "runners/answers/measure_answer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ricochet/measure/statistics/quantiles.hpp>
#include <ricochet/measure/statistics/tiers.hpp>

#include "runners/answers/answer.hpp"
#include "runners/answers/set_names.hpp"
#include "runners/answers/uncertainty.hpp"
#include "runners/study/axis_meaning.hpp"
#include "runners/table/in_order_met.hpp"

namespace ricochet::answers {
namespace {

constexpr std::size_t a_dozen = 12, sentences_at_most = 6;

struct MeasureSaid {
  std::string kind;  ///< differ, none, open, value, choices, interval
  std::vector<Sentence> sentences;
  MeasureLimits limits;
  double scale = 1;
  std::string lead = {};  ///< of kind choices: what moves it most
  double lead_size = 0;   ///< typically
  bool by_scene = false;  ///< a sentence for each scene
};

bool chaotic_means(const StudyResults& results) {
  const auto window = results.study.find("window");
  if (window == results.study.end() || !window->is_object()) return false;
  const auto parts = window->find("parts");
  return parts != window->end() && parts->is_number();
}

MeasureSaid say_measure(const Compared& study, const std::string& name, bool kept) {
  MeasureSaid out;
  const Cases all = all_cases(study.results());
  out.limits = limits_of(study, name, kept, all);
  const MeasureWords& words = out.limits.words;
  const auto have = out.limits.with_limit();
  if (have.empty()) return out;
  out.scale = scale_of(words, have);
  if (out.scale <= 0) out.scale = 1;
  const std::vector<std::string> scene = study.scene_columns();
  InOrderMet<std::string, std::vector<const Method*>> scenes;
  for (const Method* method : have) scenes[study.key(method->first(), scene)].push_back(method);
  const bool asks = !study.asked().empty();
  if (in_tiers(study, out.limits)) {
    std::tie(out.kind, out.sentences) = TierSpeaker(study, out.limits, study.columns()).tiers();
    return out;
  }
  const bool by_scene = !asks && scenes.list().size() >= 2 && scenes.list().size() <= 3 &&
                        std::all_of(scenes.list().begin(), scenes.list().end(), [](const auto& scene_methods) {
                          return scene_methods.second.size() >= 2 && scene_methods.second.size() <= a_dozen;
                        });
  if (by_scene) {
    out.kind = "differ";
    out.by_scene = true;
    std::vector<std::string> rest;
    for (const std::string& column : study.columns())
      if (std::find(scene.begin(), scene.end(), column) == scene.end()) rest.push_back(column);
    for (const auto& [key, methods] : scenes.list()) {
      Cases cases;
      for (const Method* method : methods) cases.insert(cases.end(), method->cases.begin(), method->cases.end());
      const MeasureLimits own = limits_of(study, name, keeps_energy(study.results(), cases), cases);
      auto [kind, said] = TierSpeaker(study, own, rest).tiers();
      if (said.empty()) continue;
      std::vector<std::string> where;
      for (const std::string& column : scene) where.push_back(study.level(methods.front()->first(), column));
      const std::string measure = capitalised(words.words);
      for (Sentence& one : said) {
        std::string text = one.text;
        for (const std::string& begins : {std::string("The "), std::string("None "), std::string("No "),
                                          std::string("All "), std::string("These "), measure})
          if (text.starts_with(begins) && text[0] >= 'A' && text[0] <= 'Z')
            text[0] = static_cast<char>(text[0] - 'A' + 'a');
        const char* link = text.starts_with(words.words) ? ", " : ": ";
        one.text = "With " + and_list(where) + link + text;
        out.sentences.push_back(std::move(one));
      }
    }
    return out;
  }
  out.kind = "choices";
  const std::optional<Sentence> gains = TierSpeaker(study, out.limits, study.columns()).gaining();
  const auto with_gains = [&](std::vector<Sentence> sentences) {
    if (gains) sentences.insert(sentences.begin(), *gains);
    return sentences;
  };
  if (asks) out.sentences = say_levels(study, out.limits);
  if (!out.sentences.empty()) {
    out.sentences = with_gains(std::move(out.sentences));
    return out;
  }
  const std::vector<ChoiceEffect> effects = choice_effects(study, out.limits);
  for (const ChoiceEffect& one : effects)
    if (one.typical > std::max(out.lead_size, tolerance) && 2 * one.matters > one.rows.size())
      out.lead = one.choice, out.lead_size = one.typical;
  out.sentences = with_gains(say_choices(study, out.limits, effects));
  return out;
}

/// "Only Dumont–Paoli β = ½ runs: the energy left is 98.3 ± 0.2 %": one method among several that gave nothing.
void only_one(const Compared& study, MeasureSaid& said) {
  if (said.kind != "value" || said.limits.methods.size() < 2 || said.sentences.empty()) return;
  std::string& text = said.sentences.front().text;
  const std::string begins = capitalised(said.limits.words.words) + ": ";
  if (!text.starts_with(begins)) return;
  text = fmt::format("Only {} runs: {} is {}", study.name(said.limits.with_limit().front()->first()),
                     said.limits.words.words, text.substr(begins.size()));
}

/// Whether a sentence names methods that gain energy.
bool tells_gains(const Sentence& sentence) {
  return !sentence.clauses.empty() && sentence.clauses.front().form == "gains";
}

/// Several as one, so that no method that they name is cut off.
Sentence joined_sentences(const std::vector<Sentence>& sentences) {
  Sentence out;
  for (const Sentence& one : sentences) {
    out.text += (out.text.empty() ? "" : " ") + one.text;
    out.clauses.insert(out.clauses.end(), one.clauses.begin(), one.clauses.end());
  }
  return out;
}

bool of_stop(const std::string& name) {
  return name.ends_with("]");
}

/// One sentence on the measures after the first that share a verdict.
void say_others(const std::vector<MeasureSaid>& others, const MeasureSaid& first, std::vector<Sentence>& out) {
  const std::string& first_kind = first.kind;
  const auto spread = [](const MeasureSaid& one) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Method* method : one.limits.without_gain())
      low = std::min(low, method->limit->value), high = std::max(high, method->limit->value);
    return (high - low) / one.scale;
  };
  const auto moved = [](const MeasureSaid& one) {
    double u = 0;
    for (const Method* method : one.limits.without_gain())
      if (const double own = method->limit->uncertainty.value_or(0); std::isfinite(own)) u = std::max(u, own);
    return u / one.scale;
  };
  InOrderMet<std::string, std::vector<const MeasureSaid*>> kinds;
  for (const MeasureSaid& one : others) kinds[one.kind].push_back(&one);
  const auto value_of = [&](const MeasureSaid& one, Sentence& said) {
    std::vector<double> values;
    for (const Method* method : one.limits.without_gain()) values.push_back(method->limit->value);
    const double middle = median(values);
    Clause value{.form = "value", .measure = one.limits.words.measure};
    value.value = middle * one.limits.words.factor;
    value.unit = one.limits.words.unit;
    said.clauses.push_back(std::move(value));
    return value_text(one.limits.words, middle, std::max(spread(one), moved(one)) * one.scale);
  };
  for (const auto& [kind, all] : kinds.list()) {
    // Of one alone the value is told as well, and of stops.
    const bool alone = kind == alike && all.size() == 1 && first_kind == alike;
    std::vector<std::string> names;
    Sentence said;
    for (const MeasureSaid* one : all) {
      Clause clause{.form = kind == alike ? alike : "open", .measure = one->limits.words.measure};
      clause.value = 100 * (kind == alike ? spread(*one) : moved(*one));
      clause.unit = "%";
      said.clauses.push_back(clause);
      std::vector<std::string> told;
      if (kind == alike && !alone && of_stop(one->limits.words.measure)) told.push_back(value_of(*one, said));
      if (kind == alike && by_percent(spread(*one)) != by_percent(0)) told.push_back(by_percent(spread(*one)));
      names.push_back(one->limits.words.words + (told.empty() ? "" : fmt::format(" ({})", fmt::join(told, ", "))));
    }
    if (alone) {
      const MeasureSaid& one = *all.front();
      const std::string value = value_of(one, said);
      said.text = fmt::format("{} agrees as well: {}, {} apart.", capitalised(one.limits.words.words), value,
                              by_percent(spread(one)));
      out.push_back(std::move(said));
      continue;
    }
    if (kind == alike && (all.size() > 1 || first_kind == alike)) {
      said.text = first_kind == alike
                      ? fmt::format("{} agree{} as well.", capitalised(and_list(names)), plural_s(all.size() > 1))
                      : fmt::format("No difference in {}.", and_list(names));
      out.push_back(std::move(said));
    } else if (kind == "open") {
      std::vector<std::string> sizes;
      for (const MeasureSaid* one : all) sizes.push_back(percent(moved(*one)));
      said.text = fmt::format("{} {} not told: refinement still moves {} by up to {}.", capitalised(and_list(names)),
                              all.size() > 1 ? "are" : "is", all.size() > 1 ? "them" : "it", and_list(sizes));
      out.push_back(std::move(said));
    } else if (kind == "choices" && first_kind == "choices") {
      // What moves the first measure most is named once.
      InOrderMet<std::string, std::vector<const MeasureSaid*>> leads;
      for (const MeasureSaid* one : all) leads[one->lead].push_back(one);
      for (const auto& [lead, same] : leads.list()) {
        if (lead.empty()) continue;
        Sentence moves;
        std::vector<std::string> measures, sizes;
        for (const MeasureSaid* one : same) {
          measures.push_back(one->limits.words.words);
          sizes.push_back(percent(one->lead_size));
          Clause clause{.form = "matters", .measure = one->limits.words.measure, .choice = lead};
          clause.value = 100 * one->lead_size;
          clause.unit = "%";
          clause.status = "matters";
          moves.clauses.push_back(clause);
        }
        moves.text = fmt::format("{}: {}{}, by {}.", capitalised(and_list(measures)), spoken(lead),
                                 lead == first.lead ? " again" : " most", and_list(sizes));
        out.push_back(std::move(moves));
      }
    } else {
      for (const MeasureSaid* one : all) {
        if (kind == "differ" && !one->by_scene) {
          out.push_back(joined_sentences(one->sentences));
          continue;
        }
        const std::size_t told =
            one->by_scene ? one->sentences.size() : std::min<std::size_t>(1, one->sentences.size());
        out.insert(out.end(), one->sentences.begin(), one->sentences.begin() + static_cast<std::ptrdiff_t>(told));
      }
    }
  }
}

}  // namespace

namespace {

// Whether some case says how well it knows this mean.
bool has_interval(const StudyResults& results, const std::string& name) {
  return std::any_of(results.cases.begin(), results.cases.end(), [&](const CaseRecord& one) {
    return one.status == "done" && measure(one, "confidence." + name).has_value();
  });
}

// The mean over the window that knows its interval, in the place of what the whole run adds up to.
std::string told_for(const StudyResults& results, const std::string& name) {
  if (has_interval(results, name)) return name;
  const std::size_t stop = std::min(name.find('['), name.size());
  const std::string_view given = std::string_view(name).substr(0, stop);
  for (const auto& [total, mean] :
       {std::pair("rms_force", "window_contact_rms_force"), std::pair("mean_force", "window_contact_force"),
        std::pair("impulse", "window_force"), std::pair("contact_time", "window_contact_share"),
        std::pair("impacts", "window_impact_rate"), std::pair("dissipated_at_contact", "window_power")})
    if (const std::string in_window = mean + name.substr(stop); given == total && has_interval(results, in_window))
      return in_window;
  return name;
}

}  // namespace

Answer measure_answer(const Compared& study, const std::vector<std::string>& measures, bool status_first) {
  Answer answer;
  const StudyResults& results = study.results();
  const bool any_done = std::any_of(results.cases.begin(), results.cases.end(),
                                    [](const CaseRecord& record) { return record.status == "done"; });
  if (status_first)
    for (Sentence& one : status(study)) answer.say(std::move(one));
  if (!any_done && !results.cases.empty() && !status_first)
    answer.say("Nothing ran.", Clause{.form = "status", .status = "none"});
  constexpr std::size_t measures_at_most = 4, too_many_cases = 20000;
  const bool kept = keeps_energy(results);
  std::vector<Sentence> body;
  std::vector<MeasureLimits> blank;  // of measures that some method has no value of
  std::vector<MeasureSaid> others;
  MeasureSaid first;
  Sentence gain;
  if (any_done && results.cases.size() <= too_many_cases)
    for (std::size_t k = 0; k < std::min(measures.size(), measures_at_most); ++k) {
      const std::string name = told_for(results, measures[k]);
      MeasureSaid said = say_measure(study, name, kept);
      if (!said.limits.without_value().empty()) blank.push_back(said.limits);
      // Gains of energy are said once, before all else.
      const auto gains = std::stable_partition(said.sentences.begin(), said.sentences.end(), tells_gains);
      if (gain.text.empty() && gains != said.sentences.begin())
        gain = joined_sentences({said.sentences.begin(), gains});
      said.sentences.erase(said.sentences.begin(), gains);
      if (said.sentences.empty()) continue;
      // What methods and refinement leave of a stop's measure; a choice that is asked for speaks by itself.
      if (study.asked().empty() && (said.kind == "differ" || said.kind == "choices" || said.kind == "open"))
        if (std::optional<Sentence> interval = uncertainty_sentence(study, said.limits)) {
          said.kind = "interval";
          said.sentences = {std::move(*interval)};
        }
      // Choices are told by what they move, never by what the measure is.
      if (study.asked().empty() && said.kind == "choices")
        if (std::optional<Sentence> values = values_sentence(study, said.limits)) {
          said.kind = "interval";
          said.sentences.insert(said.sentences.begin(), std::move(*values));
        }
      if (chaotic_means(results) && !of_stop(name) && !name.starts_with("window") && !has_interval(results, name)) {
        body.push_back({fmt::format("{} is not compared: the motion is chaotic, its means are.",
                                    capitalised(said.limits.words.words)),
                        {Clause{.form = "open", .measure = name, .status = "chaotic"}}});
        continue;
      }
      if (first.kind.empty()) {
        only_one(study, said);
        constexpr std::size_t three = 3;
        const std::size_t of_first = said.by_scene ? sentences_at_most : three;
        for (std::size_t s = 0; s < std::min(of_first, said.sentences.size()); ++s) body.push_back(said.sentences[s]);
        first = std::move(said);
        continue;
      }
      // Of which more than half the methods are restless nothing is told, whatever its tiers.
      const auto have = said.limits.with_limit();
      const auto restless = static_cast<std::size_t>(std::count_if(have.begin(), have.end(), [&](const Method* one) {
        return one->limit->restless() && one->limit->uncertainty.value_or(0) > 2 * tolerance * said.scale;
      }));
      if (said.kind == "differ" && 2 * restless > have.size()) said.kind = "open";
      others.push_back(std::move(said));
    }
  say_others(others, first, body);
  const std::size_t room = status_first ? 2 : sentences_at_most;
  if (any_done && gain.text.empty()) {
    const MeasureLimits energy = limits_of(study, "energy_left", kept, all_cases(results));
    if (auto found = TierSpeaker(study, energy, study.columns()).gaining()) gain = std::move(*found);
  }
  if (auto untouched = say_untouched(study)) answer.say(std::move(*untouched));
  if (!gain.text.empty()) answer.say(std::move(gain));
  for (std::size_t k = 0; k < std::min(room, body.size()); ++k) answer.say(std::move(body[k]));
  if (!status_first)
    for (Sentence& one : say_without_value(study, blank)) answer.say(std::move(one));
  if (!status_first)
    for (Sentence& one : ended(study)) answer.say(std::move(one));
  return answer;
}

}  // namespace ricochet::answers
