#pragma once
#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>

#include "runners/study/study.hpp"
#include "runners/workers/worker_messages.hpp"

namespace ricochet {

/// A worker ended, or gave up.
struct Lost {
  WorkerEnd end;
  std::optional<GivenUp> given_up;
};

/// What a worker said in the end, or how it was lost.
struct Reply {
  Message message;
  std::optional<Lost> lost;
};

/// Ends one that said what is no message.
Lost ended_for_nonsense(Worker& worker);

/// What a worker answered; nothing where it was lost, as it is where it says something else.
template <class T>
std::optional<T> answer_in(Reply& reply, std::initializer_list<Message::Word> words, Worker& worker) {
  if (reply.lost) return std::nullopt;
  if (std::find(words.begin(), words.end(), reply.message.word) != words.end()) try {
      return message_from<T>(reply.message.content);
    } catch (const NoMessage&) {
    }
  reply.lost = ended_for_nonsense(worker);
  return std::nullopt;
}

/// Throws where a worker on this host did not open the study (an InputError with its pointer), or is of another
/// program, of other plugins or of another arithmetic.
void check_ready(const WorkerReady& ready, const std::string& host, const std::string& identity,
                 const std::string& arithmetic);

/// s that a call of a plugin's function may last for this case: its budget, or 60 where it has none.
double longest_call_of(const StudyCase& study_case);

/// s for which a process is waited for that a signal stopped in a call for this case, or for none.
double longest_stop_of(const StudyCase* study_case);

/// Whether a call lasted longer than the budget that the case states.
bool over_budget(const Lost& lost, const StudyCase& study_case);

/// Whether the case fails by the loss: it has a budget and used it up, a third-party function stopped the process, or a
/// second worker is lost with it. `attempt` counts these workers from 1; a machine that is gone does not count.
bool failed_by(const Lost& lost, const StudyCase& study_case, int& attempt);

/// "plugin contact 'x' (x.so), solve(): its process was ended twice by …": why it failed.
std::string sentence(const Lost& lost, const StudyCase& study_case);

}  // namespace ricochet
