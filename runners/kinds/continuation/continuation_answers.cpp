#include "runners/kinds/continuation/continuation_answers.hpp"

#include "runners/kinds/continuation/point_speaker.hpp"

namespace ricochet {

answers::Answer continuation_answer(const answers::Compared& study) {
  answers::Answer answer;
  const PointSpeaker speaker(study);
  if (speaker.known()) {
    speaker.say_points(answer);
    speaker.say_unconfirmed(answer);
    speaker.say_shifts(answer);
    speaker.say_absent(answer);
    speaker.say_turns(answer);
  } else {
    speaker.say_nothing(answer);
  }
  constexpr std::size_t most = 6;
  answer.keep(most);
  for (answers::Sentence& one : answers::ended(study)) answer.say(std::move(one));
  return answer;
}

}  // namespace ricochet
