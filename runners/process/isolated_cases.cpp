#include "runners/process/isolated_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <ricochet/contract/errors.hpp>

#include "runners/march/prepare_case.hpp"
#include "runners/process/key_claims.hpp"
#include "runners/process/worker_messages.hpp"
#include "runners/process/worker_process.hpp"
#include "runners/run/study_identity.hpp"

namespace ricochet {
namespace {

using Word = Message::Word;
using Clock = std::chrono::steady_clock;

constexpr double look_up = 0.25;        // s between two looks at `stop`
constexpr double longest_silence = 60;  // s; a worker says every second that it is there
constexpr double after_stop = 6;        // s for coming back
constexpr double longest_call = 60;     // s for one call of a plugin's function, where a case has no budget
constexpr int attempts = 2;

double since(Clock::time_point then) {
  return std::chrono::duration<double>(Clock::now() - then).count();
}

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

}  // namespace

class IsolatedCases::Desk {
 public:
  Desk(const RunContext& context, const IsolationOptions& options)
      : context_(context), identity_(context.study, context.registry) {
    opening_.study = context.study.resolved.dump();
    for (const auto& plugin : options.plugins) opening_.plugins.push_back(std::filesystem::absolute(plugin).string());
    opening_.memory = options.memory;
  }

  /// A first worker is there, and what only shows where a study is opened has shown.
  void open(MotionShelf shelf, const std::atomic<bool>& stop) {
    shelf_ = std::move(shelf);
    give_back(take(stop));
  }

  CaseAnswer ask(Word word, const StudyCase& study_case, const std::atomic<bool>& stop) {
    CaseOrder order{study_case.id, context_.jobs, budget_of(study_case)};
    const bool unlimited = !std::isfinite(order.budget);
    if (unlimited) order.budget = longest_call;
    for (int attempt = 1;; ++attempt) {
      std::unique_ptr<Worker> worker = take(stop);
      Reply reply = talk(*worker, {word, to_bytes(order)}, stop);
      claims_.release(worker->number);
      if (!reply.lost) {
        give_back(std::move(worker));
        if (reply.message.word == Word::interrupted) throw Interrupted{};
        return message_from<CaseAnswer>(reply.message.content);
      }
      if (stop) throw Interrupted{};
      if (reply.lost->given_up && !unlimited)
        throw std::runtime_error(fmt::format("plugin {} did not return from {}() within the budget of {:g} s",
                                             reply.lost->given_up->plugin, reply.lost->given_up->function,
                                             order.budget));
      if (attempt < attempts) continue;
      throw std::runtime_error(sentence(*reply.lost) + ", twice");
    }
  }

 private:
  struct Worker : WorkerProcess {
    int number = 0;
  };

  static std::string sentence(const Lost& lost) {
    if (lost.given_up)
      return fmt::format("plugin {} did not return from {}() within {:g} s; its process was ended",
                         lost.given_up->plugin, lost.given_up->function, lost.given_up->budget);
    return lost.end.sentence();
  }

  std::unique_ptr<Worker> take(const std::atomic<bool>& stop) {
    auto worker = std::make_unique<Worker>();
    {
      const std::lock_guard guard(mutex_);
      if (!idle_.empty()) {
        worker = std::move(idle_.back());
        idle_.pop_back();
        return worker;
      }
      worker->number = ++born_;
    }
    const Reply reply = talk(*worker, {Word::study, to_bytes(opening_)}, stop);
    if (reply.lost) {
      if (stop) throw Interrupted{};
      throw std::runtime_error("a worker did not open the study: " + sentence(*reply.lost));
    }
    const auto ready = message_from<WorkerReady>(reply.message.content);
    if (!ready.failure.empty() && !ready.pointer.empty()) throw InputError(ready.pointer, ready.failure);
    if (!ready.failure.empty()) throw std::runtime_error("a worker did not open the study: " + ready.failure);
    if (ready.identity != identity_.of_all())
      throw std::runtime_error("a worker has another program or other plugins than this process");
    return worker;
  }

  void give_back(std::unique_ptr<Worker> worker) {
    const std::lock_guard guard(mutex_);
    idle_.push_back(std::move(worker));
  }

  /// Sends an order and serves the worker until it is done with it.
  Reply talk(Worker& worker, Message order, const std::atomic<bool>& stop) {
    order.about = 1;
    Reply reply;
    std::optional<GivenUp> given_up;
    std::optional<Clock::time_point> told_to_stop;
    Clock::time_point heard = Clock::now();
    bool silent = false;
    Channel::Heard state = worker.channel().send(order) ? Channel::Heard::silence : Channel::Heard::gone;
    while (state != Channel::Heard::gone) {
      state = worker.channel().receive(reply.message, look_up);
      if (stop && !told_to_stop) {
        told_to_stop = Clock::now();
        worker.channel().send({Word::stop});
      }
      if (state == Channel::Heard::silence) {
        silent = since(heard) > longest_silence;
        if (silent || (told_to_stop && since(*told_to_stop) > after_stop)) worker.kill();
      }
      if (state != Channel::Heard::message) continue;
      heard = Clock::now();
      if (told_to_stop && since(*told_to_stop) > after_stop) worker.kill();
      if (reply.message.word == Word::given_up)
        given_up = message_from<GivenUp>(reply.message.content);
      else if (reply.message.word != Word::alive && !serve(worker, reply.message, stop))
        return reply;
    }
    reply.lost = Lost{worker.end(), given_up};
    reply.lost->end.silent = silent;
    return reply;
  }

  /// Answers what a worker asks for; false where the message is what it was asked for.
  bool serve(Worker& worker, const Message& message, const std::atomic<bool>& stop) {
    const auto answer = [&](std::string content) {
      worker.channel().send({Word::answer, std::move(content), message.about});
    };
    if (message.word == Word::find) {
      answer(claims_.find(
          worker.number, message.content, [&] { return shelf_.find ? shelf_.find(message.content) : ""; }, stop));
    } else if (message.word == Word::keep) {
      const auto kept = message_from<ShelfMessage>(message.content);
      if (shelf_.keep) shelf_.keep(kept.key, kept.content);
      claims_.kept(kept.key);
      answer("");
    } else if (message.word == Word::failed) {
      answer(shelf_.failed && shelf_.failed(message.content) ? "failed" : "");
    } else if (message.word == Word::show) {
      CaseRecord record = message_from<CaseRecord>(message.content);
      if (const StudyCase* one = find_case(context_.study, record.id)) record.axes = one->axes;
      if (shelf_.show) shelf_.show(record);
    } else {
      return false;
    }
    return true;
  }

  const RunContext context_;
  StudyIdentity identity_;
  WorkerStudy opening_;
  MotionShelf shelf_;
  KeyClaims claims_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Worker>> idle_;
  int born_ = 0;
};

IsolatedCases::IsolatedCases(const RunContext& context, const IsolationOptions& options)
    : desk_(std::make_shared<Desk>(context, options)) {}
IsolatedCases::~IsolatedCases() = default;

CaseRunner IsolatedCases::runner() {
  CaseRunner runner;
  runner.open = [desk = desk_](MotionShelf shelf, const std::atomic<bool>& stop) {
    desk->open(std::move(shelf), stop);
  };
  runner.run = [desk = desk_](const StudyCase& study_case, const std::atomic<bool>& stop) {
    return desk->ask(Word::run, study_case, stop).record;
  };
  return runner;
}

double IsolatedCases::predicted_seconds(const StudyCase& study_case) {
  static const std::atomic<bool> never{false};
  const CaseAnswer answer = desk_->ask(Word::plan, study_case, never);
  if (!answer.error.empty()) throw std::runtime_error(answer.error);
  return answer.seconds;
}

}  // namespace ricochet
