#include "runners/workers/isolated_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>
#include <ricochet/contract/errors.hpp>

#include "runners/march/prepare_case.hpp"
#include "runners/march/seconds.hpp"
#include "runners/march/study_identity.hpp"
#include "runners/plan_files/plan_file.hpp"
#include "runners/workers/lost_worker.hpp"
#include "runners/workers/worker_messages.hpp"
#include "runners/workers/worker_process.hpp"

namespace ricochet {
namespace {

using Word = Message::Word;
using Clock = std::chrono::steady_clock;

constexpr double poll_interval = 0.25;  // s between two readings of `stop`
constexpr double after_stop = 6;        // s for coming back; for a case that waits for its blocks, a little longer
constexpr int attempts = 2;             // to open a study

}  // namespace

class IsolatedCases::Coordinator {
 public:
  Coordinator(const RunContext& context, const IsolationOptions& options)
      : context_(context),
        of_all_(StudyIdentity(context.study, context.registry).of_all()),
        kind_(find_kind(context.study.kind)->start(context)),
        places_(options.hosts.empty()
                    ? std::vector<std::shared_ptr<WorkerHost>>{std::make_shared<LocalHost>(options.jobs)}
                    : options.hosts),
        pool_(places_.width(), [this](const BlockPool::Block& block, const std::function<bool()>& stopping) {
          march(block, stopping);
        }) {
    opening_.study = context.study.resolved.dump();
    // Plans travel with the study.
    for (const auto& plugin : options.plugins)
      if (!is_plan_file(plugin)) opening_.plugins.push_back(std::filesystem::absolute(plugin).string());
    opening_.width = places_.width();
    opening_.arithmetic = arithmetic_digest();
  }

  /// A first worker is there, and what only shows where a study is opened has shown.
  void open(CheckpointStore checkpoints, const std::atomic<bool>& stop) {
    checkpoints_ = std::move(checkpoints);
    places_.give_back(take(Where::here, [&] { return stop.load(); }).member);
  }

  std::string workers_in_words() const {
    const int workers = places_.width(), machines = places_.machines();
    return fmt::format("{} worker{}{}", workers, workers == 1 ? "" : "s",
                       machines > 1 ? fmt::format(" on {} machines", machines) : "");
  }
  int cases_at_once() const {
    constexpr int held = 4;  // of each of its own workers: a case that waits for its blocks takes memory, not time
    const int all = places_.width();
    return kind_.block ? std::min(all, std::max(held * places_.width_here(), 2 * held)) : all;
  }

  bool times() const { return static_cast<bool>(kind_.time); }

  bool blocks() const { return static_cast<bool>(kind_.block); }

  /// `before`: how a worker was lost with the case, where one was.
  CaseAnswer ask(Word word, const StudyCase& study_case, const std::atomic<bool>& stop, const Lost* before = nullptr) {
    const auto stopping = [&] { return stop.load(); };
    // Each pending case was planned before the first one ran.
    if (word == Word::plan) ++open_;
    const OpenCase open(open_, word == Word::run);
    int attempt = 1;
    const auto count = [&](const Lost& lost) {
      if (stop) throw Interrupted{};
      if (failed_by(lost, study_case, attempt)) throw std::runtime_error(sentence(lost, study_case));
    };
    if (before) count(*before);
    for (;;) {
      const Taken taken = take(place_of(word), stopping);
      Reply reply = talk_of_case(taken.member, Message{word, to_bytes(std::vector{order_of(study_case)})},
                                 study_case.id, stopping);
      pass_run_error();
      if (auto answer = answer_in<CaseAnswer>(reply, {Word::planned, Word::ran, Word::timed}, *taken.member->worker)) {
        places_.give_back(taken.member);
        return std::move(*answer);
      }
      count(*reply.lost);
    }
  }

  /// Runs the cases one after the other. The one with which a worker is lost is asked for again alone.
  void run_several(const std::vector<const StudyCase*>& cases, const std::function<void(CaseRecord)>& ended,
                   const std::atomic<bool>& stop) {
    for (std::size_t next = 0; next < cases.size(); ++next) {
      const std::optional<Lost> lost = run_by_one_worker(cases, next, ended, stop);
      if (!lost) return;
      CaseRunner again;
      again.run = [&](const StudyCase& study_case, const std::atomic<bool>&) {
        return ask(Word::run, study_case, stop, &*lost).record;
      };
      ended(run_guarded(again, *cases[next], stop));
    }
  }

 private:
  using Where = WorkerPlaces::Where;
  using Taken = WorkerPlaces::Taken;
  using MemberPointer = WorkerPlaces::MemberPointer;

  /// A case whose blocks others march keeps what they made, and waits: beside the store. What is timed is timed on one
  /// machine.
  Where place_of(Word word) const {
    return word == Word::time || (word == Word::run && kind_.block) ? Where::here : Where::anywhere;
  }

  /// The cases from `next` on, which counts those that ended. How the worker was lost; nothing where all have ended.
  std::optional<Lost> run_by_one_worker(const std::vector<const StudyCase*>& cases, std::size_t& next,
                                        const std::function<void(CaseRecord)>& ended, const std::atomic<bool>& stop) {
    const auto stopping = [&] { return stop.load(); };
    const Taken taken = take(Where::anywhere, stopping);
    std::vector<CaseOrder> orders;
    for (std::size_t i = next; i < cases.size(); ++i) orders.push_back(order_of(*cases[i]));
    std::optional<Message> message = Message{Word::run, to_bytes(orders)};
    for (; next < cases.size(); ++next) {
      const StudyCase& one = *cases[next];
      Reply reply = talk_of_case(taken.member, std::exchange(message, std::nullopt), one.id, stopping);
      auto answer = answer_in<CaseAnswer>(reply, {Word::ran}, *taken.member->worker);
      if (!answer) return reply.lost;
      --open_;
      answer->record.id = one.id;
      answer->record.axes = one.axes;
      ended(std::move(answer->record));
    }
    places_.give_back(taken.member);
    return std::nullopt;
  }

  /// A case that runs is open until it has.
  class OpenCase {
   public:
    OpenCase(std::atomic<int>& open, bool counts) : open_(open), counts_(counts) {}
    ~OpenCase() {
      if (counts_) --open_;
    }
    OpenCase(const OpenCase&) = delete;
    OpenCase& operator=(const OpenCase&) = delete;

   private:
    std::atomic<int>& open_;
    const bool counts_;
  };

  CaseOrder order_of(const StudyCase& study_case) const {
    return {study_case.id, longest_call_of(study_case), share()};
  }

  /// talk(), and what the worker claimed or began for its case is let go, however it ends. Throws Interrupted.
  Reply talk_of_case(const MemberPointer& member, std::optional<Message> order, const std::string& id,
                     const std::function<bool()>& stopping) {
    const auto let_go = [this](const MemberPointer* one) {
      claims_.release((*one)->number);
      pool_.forget((*one)->number);
    };
    Reply reply;
    {
      const std::unique_ptr<const MemberPointer, decltype(let_go)> in_work(&member, let_go);
      reply = talk(member, std::move(order), id, stopping, 2 * after_stop);
    }
    if (!reply.lost && reply.message.word == Word::interrupted) {
      places_.give_back(member);
      throw Interrupted{};
    }
    return reply;
  }

  /// Workers for each case that is left.
  int share() const {
    const int width = places_.width();
    return width / std::clamp(open_.load(), 1, width);
  }

  /// Has a block marched by a worker, for the one that asked.
  void march(const BlockPool::Block& block, const std::function<bool()>& stopping) {
    const auto tell = [&](BlockStatus::What what, std::string content) {
      block.tell(BlockStatus{what, std::move(content)});
    };
    try {
      BlockRequest request = block.request;
      const StudyCase* const study_case = find_case(context_.study, request.id);
      if (!study_case) throw std::runtime_error("a block of no case");
      request.budget = longest_call_of(*study_case);
      Reply reply;
      do {
        const Taken taken = take(Where::anywhere, stopping);
        reply =
            talk(taken.member, Message{Word::block, to_bytes(request)}, request.id, stopping, after_stop, block.tell);
        if (auto status = answer_in<BlockStatus>(reply, {Word::block_status}, *taken.member->worker)) {
          places_.give_back(taken.member);
          return block.tell(std::move(*status));
        }
      } while (reply.lost->end.host_lost && !stopping());
      if (stopping()) return tell(BlockStatus::What::interrupted, "");
      const bool over = over_budget(*reply.lost, *study_case);
      tell(over ? BlockStatus::What::gave_up : BlockStatus::What::lost, sentence(*reply.lost, *study_case));
    } catch (const Interrupted&) {
      tell(BlockStatus::What::interrupted, "");
    } catch (const RunError& error) {
      {
        const std::lock_guard guard(run_error_mutex_);
        run_error_ = error;
      }
      tell(BlockStatus::What::failed, error.what());
    } catch (const std::exception& error) {
      tell(BlockStatus::What::failed, error.what());
    }
  }

  /// What a block met ends the run.
  void pass_run_error() {
    const std::lock_guard guard(run_error_mutex_);
    if (run_error_) throw RunError(*run_error_);
  }

  /// A worker that has opened the study.
  Taken take(Where where, const std::function<bool()>& stopping) {
    for (int attempt = 1;;) {
      Taken taken = places_.take(where);
      if (taken.member->worker) return taken;
      const std::string name = taken.member->host->name();
      taken.member->worker = taken.member->host->start();
      WorkerStudy opening = opening_;
      opening.memory = taken.member->host->memory();
      Reply reply = talk(taken.member, Message{Word::study, to_bytes(opening)}, "", stopping, after_stop);
      if (const auto ready = answer_in<WorkerReady>(reply, {Word::ready}, *taken.member->worker)) {
        check_ready(*ready, name, of_all_, opening_.arithmetic);
        return taken;
      }
      if (stopping()) throw Interrupted{};
      if (reply.lost->end.host_lost) continue;
      if (attempt++ == attempts) {
        const WorkerEnd& end = reply.lost->end;
        throw RunError(fmt::format("no worker on {} opens the study: {}", name, end.sentence("twice")), !end.no_memory);
      }
    }
  }

  /// Sends an order for a case, unless it has it already, and serves the worker until it is done with it. `patience`: s
  /// for coming back after `stopping`.
  Reply talk(const MemberPointer& member, std::optional<Message> order, const std::string& id,
             const std::function<bool()>& stopping, double patience,
             const std::function<void(BlockStatus)>& so_far = {}) {
    if (order) order->about = 1;
    Worker& worker = *member->worker;
    Reply reply;
    std::optional<GivenUp> given_up;
    std::optional<Clock::time_point> told_to_stop;
    Clock::time_point heard_at = Clock::now();
    double quiet = 0;  // s, of those in which this process was not stopped itself
    bool silent = false, waits = false;
    // Which call of a plugin's function the worker waits for, "" for none.
    const auto waiting = [&](const std::string& call) {
      if (checkpoints_.waiting && (waits || !call.empty())) checkpoints_.waiting(id, call);
      waits = !call.empty();
    };
    Channel::Heard state = !order || worker.send(*order) ? Channel::Heard::silence : Channel::Heard::gone;
    while (state != Channel::Heard::gone) {
      state = worker.receive(reply.message, poll_interval);
      if (!told_to_stop && stopping()) {
        told_to_stop = Clock::now();
        worker.send({Word::stop});
      }
      if (told_to_stop && seconds_since(*told_to_stop) > patience) worker.kill();
      quiet += std::min(seconds_since(heard_at), 2 * poll_interval);
      heard_at = Clock::now();
      // One that was killed for its silence may take a while to end, and is then no longer seen as stopped.
      if (state == Channel::Heard::silence && !silent) {
        const bool stopped = quiet > 2 * alive_every && worker.stopped();
        silent = quiet > (stopped ? longest_stop_of(find_case(context_.study, id)) : lost_after);
        if (silent) worker.kill();
      }
      if (state != Channel::Heard::message) continue;
      quiet = 0;
      try {
        if (reply.message.word == Word::given_up) {
          given_up = message_from<GivenUp>(reply.message.content);
        } else if (reply.message.word == Word::block_status) {
          auto status = message_from<BlockStatus>(reply.message.content);
          if (status.what != BlockStatus::What::so_far) return reply;
          if (so_far) so_far(std::move(status));
        } else if (reply.message.word == Word::alive) {
          waiting(reply.message.content);
        } else if (!serve(member, reply.message, stopping)) {
          waiting("");
          return reply;
        }
      } catch (const NoMessage&) {
        reply.lost = ended_for_nonsense(worker);
        return reply;
      }
    }
    waiting("");
    reply.lost = Lost{worker.end(), given_up};
    reply.lost->end.silent = silent;
    return reply;
  }

  /// Answers what a worker asks for; false where the message is what it was asked for.
  bool serve(const MemberPointer& member, const Message& message, const std::function<bool()>& stopping) {
    const auto answer = [&](std::string content) {
      member->worker->send({Word::answer, std::move(content), message.about});
    };
    if (message.word == Word::find) {
      answer(claims_.find(
          member->number, message.content, [&] { return checkpoints_.find ? checkpoints_.find(message.content) : ""; },
          stopping));
    } else if (message.word == Word::keep) {
      const auto kept = message_from<ShelfMessage>(message.content);
      if (checkpoints_.keep) checkpoints_.keep(kept.key, kept.content);
      claims_.kept(kept.key);
      answer("");
    } else if (message.word == Word::failed) {
      answer(checkpoints_.failed && checkpoints_.failed(message.content) ? "failed" : "");
    } else if (message.word == Word::show) {
      CaseRecord record = message_from<CaseRecord>(message.content);
      if (const StudyCase* one = find_case(context_.study, record.id)) record.axes = one->axes;
      if (checkpoints_.show) checkpoints_.show(record);
    } else if (message.word == Word::march) {
      pool_.begin({message_from<BlockRequest>(message.content), member->number, message.about,
                   [this, member, about = message.about](BlockStatus status) {
                     status.share = share();
                     member->worker->send({Word::block_status, to_bytes(status), about});
                   }});
    } else if (message.word == Word::cancel) {
      pool_.stop(member->number, message.about);
    } else {
      return false;
    }
    return true;
  }

  const RunContext context_;
  const std::string of_all_;
  const CaseRunner kind_;  // what this kind's cases are asked for; nothing of it runs here
  WorkerStudy opening_;
  CheckpointStore checkpoints_;
  KeyClaims claims_;
  std::mutex run_error_mutex_;
  std::optional<RunError> run_error_;  // met by a block
  std::atomic<int> open_{0};           // cases that were planned and have not run to their end
  WorkerPlaces places_;
  BlockPool pool_;  // last: its threads use all of the above
};

IsolatedCases::IsolatedCases(const RunContext& context, const IsolationOptions& options)
    : coordinator_(std::make_shared<Coordinator>(context, options)) {}
IsolatedCases::~IsolatedCases() = default;

std::string IsolatedCases::workers_in_words() const {
  return coordinator_->workers_in_words();
}

int IsolatedCases::cases_at_once() const {
  return coordinator_->cases_at_once();
}

CaseRunner IsolatedCases::runner() {
  CaseRunner runner;
  runner.open = [coordinator = coordinator_](CheckpointStore checkpoints, const std::atomic<bool>& stop) {
    coordinator->open(std::move(checkpoints), stop);
  };
  runner.run = [coordinator = coordinator_](const StudyCase& study_case, const std::atomic<bool>& stop) {
    return coordinator->ask(Word::run, study_case, stop).record;
  };
  // A case whose blocks others march waits for them: no other one stands behind it.
  if (!coordinator_->blocks())
    runner.run_several = [coordinator = coordinator_](
                             const std::vector<const StudyCase*>& cases, const std::function<void(CaseRecord)>& ended,
                             const std::atomic<bool>& stop) { coordinator->run_several(cases, ended, stop); };
  if (coordinator_->times())
    runner.time = [coordinator = coordinator_](const StudyCase& study_case, const std::atomic<bool>& stop) {
      const CaseAnswer answer = coordinator->ask(Word::time, study_case, stop);
      if (!answer.error.empty()) throw std::runtime_error(answer.error);
      return answer.found ? std::optional(TimedMarch{answer.seconds, answer.processor}) : std::nullopt;
    };
  return runner;
}

double IsolatedCases::predicted_seconds(const StudyCase& study_case) {
  const CaseAnswer answer = coordinator_->ask(Word::plan, study_case, std::atomic<bool>{false});
  if (!answer.pointer.empty()) throw InputError(answer.pointer, answer.error);
  if (!answer.error.empty()) throw std::runtime_error(answer.error);
  return answer.seconds;
}

}  // namespace ricochet
