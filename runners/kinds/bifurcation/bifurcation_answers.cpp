#include "runners/kinds/bifurcation/bifurcation_answers.hpp"

#include "runners/kinds/bifurcation/diagram_speaker.hpp"

namespace ricochet {

answers::Answer bifurcation_answer(const answers::Compared& study) {
  answers::Answer answer;
  const DiagramSpeaker diagram(study);
  if (diagram.known()) {
    const bool asked = diagram.random_starts();
    if (asked) diagram.say_coexistence(answer);
    diagram.say_methods(answer);
    diagram.say_steps(answer);
    diagram.say_robust(answer);
    if (!diagram.all_robust()) diagram.say_motions(answer);
    diagram.say_changes(answer);
    diagram.say_speeds(answer);
    if (!asked) diagram.say_coexistence(answer);
  }
  constexpr std::size_t most = 6;
  answer.keep(most);
  if (answer.sentences.empty())
    answer.say("No orbit was decided.", answers::Clause{.form = "status", .status = "none"});
  for (answers::Sentence& one : answers::ended(study)) answer.say(std::move(one));
  return answer;
}

}  // namespace ricochet
