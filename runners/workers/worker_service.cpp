#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <future>
#include <limits>
#include <map>
#include <new>
#include <optional>
#include <ricochet/contract/errors.hpp>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/loader/child.hpp>
#include <system_error>
#include <thread>
#include <unordered_map>

#include "runners/kinds/kind.hpp"
#include "runners/march/seconds.hpp"
#include "runners/march/study_identity.hpp"
#include "runners/plan_files/plan_file.hpp"
#include "runners/study/load_study.hpp"
#include "runners/workers/call_watch.hpp"
#include "runners/workers/worker_messages.hpp"
#include "runners/workers/worker_process.hpp"

namespace ricochet {
namespace {

using Word = Message::Word;

constexpr auto kPollEvery = std::chrono::milliseconds(250);
constexpr int kRoundsPerAlive = static_cast<int>(alive_every * 1000) / static_cast<int>(kPollEvery.count());
constexpr double kLeast = 2;      // s that any call of a plugin's function may take
constexpr double kAfterStop = 3;  // s for coming back
constexpr int kGaveUp = 1;

CallNote* own_note = nullptr;
std::uint64_t memory_allowed = 0;

// What a plugin asks for beyond the limit ends this process: the coordinator then knows which orbits asked.
void out_of_memory() {
  own_note->memory_exceeded = memory_allowed;
  ::_exit(kGaveUp);
}

// Static destructors of plugins do not run.
void on_exit_called() {
  own_note->exit_called = true;
  ::_exit(kGaveUp);
}

class WorkerService : public BlockService {
 public:
  WorkerService() : channel_(kWorkerChannel) {}

  int run() {
    try {
      std::thread([this] { read(); }).detach();
      std::thread([this] {
        for (int rounds = 1;; ++rounds) {
          std::this_thread::sleep_for(kPollEvery);
          const std::string waiting = long_call();
          if (rounds % kRoundsPerAlive == 0) tell({Word::alive, waiting});
        }
      }).detach();
    } catch (const std::system_error&) {  // no room for a thread
      out_of_memory();
    }
    for (;;) serve(next());
  }

  int width() const override { return width_; }
  int share() const override { return share_; }

  int begin(const std::string& case_id, const std::string& order, std::function<void(BlockStatus)> heard) override {
    std::uint32_t about = 0;
    {
      const std::lock_guard guard(mutex_);
      about = ++asked_;
      heard_[about] = std::move(heard);
    }
    tell({Word::march, to_bytes(BlockRequest{case_id, order, 0}), about});
    return static_cast<int>(about);
  }

  void stop(int block) override { tell({Word::cancel, "", static_cast<std::uint32_t>(block)}); }

 private:
  /// Without a coordinator there is nothing to do, whatever is under way.
  void tell(const Message& message) {
    if (!channel_.send(message)) ::_exit(0);
  }

  void read() {
    Message message;
    while (channel_.receive(message) == Channel::Heard::message) {
      if (message.word == Word::stop) stop_ = true;
      if (message.word == Word::block_status) {
        hear(message);
        continue;
      }
      const std::lock_guard guard(mutex_);
      if (message.word == Word::answer) {
        if (const auto asked = questions_.extract(message.about); !asked.empty())
          asked.mapped().set_value(std::move(message.content));
      } else if (message.word != Word::stop) {
        orders_.push_back(std::move(message));
        changed_.notify_all();
      }
    }
    ::_exit(0);
  }

  void hear(const Message& message) {
    auto status = message_from<BlockStatus>(message.content);
    std::function<void(BlockStatus)> heard;
    {
      const std::lock_guard guard(mutex_);
      const auto found = heard_.find(message.about);
      if (found == heard_.end()) return;
      heard = found->second;
      if (status.what != BlockStatus::What::so_far) heard_.erase(found);
    }
    if (status.share > 0) share_ = status.share;
    heard(std::move(status));
  }

  Message next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !orders_.empty(); });
    Message order = std::move(orders_.front());
    orders_.pop_front();
    return order;
  }

  std::string ask(Word word, std::string content) {
    std::future<std::string> answer;
    std::uint32_t about = 0;
    {
      const std::lock_guard guard(mutex_);
      about = ++asked_;
      answer = questions_[about].get_future();
    }
    tell({word, std::move(content), about});
    return answer.get();
  }

  void serve(const Message& order) {
    if (order.word == Word::study) return tell({Word::ready, to_bytes(open(order.content)), order.about});
    stop_ = false;
    if (order.word == Word::block) return serve_block(message_from<BlockRequest>(order.content), order.about);
    for (const CaseOrder& one : message_from<std::vector<CaseOrder>>(order.content))
      if (!serve_case(order.word, one, order.about)) return;
  }

  /// False: interrupted.
  bool serve_case(Word word, const CaseOrder& request, std::uint32_t about) {
    const StudyCase& study_case = *case_of_.at(request.id);
    share_ = request.share;
    CaseAnswer answer;
    const Caught caught = watched(request.budget, about, [&] { answer = answer_to(word, study_case); });
    if (caught.interrupted) {
      tell({Word::interrupted, "", about});
      return false;
    }
    answer.error = caught.error;
    answer.pointer = caught.pointer;
    tell({word == Word::plan ? Word::planned : word == Word::run ? Word::ran : Word::timed, to_bytes(answer), about});
    return true;
  }

  void serve_block(const BlockRequest& request, std::uint32_t about) {
    const StudyCase& study_case = *case_of_.at(request.id);
    const auto status = [&](BlockStatus::What what, std::string content) {
      tell({Word::block_status, to_bytes(BlockStatus{what, std::move(content)}), about});
    };
    std::string answer;
    const Caught caught = watched(request.budget, about, [&] {
      answer = cases_.block(
          study_case, request.order, [&](std::string bytes) { status(BlockStatus::What::so_far, std::move(bytes)); },
          stop_);
    });
    if (caught.interrupted) return status(BlockStatus::What::interrupted, "");
    if (!caught.error.empty()) return status(BlockStatus::What::failed, caught.error);
    status(BlockStatus::What::done, std::move(answer));
  }

  /// What was thrown where a case or a block was worked for.
  struct Caught {
    bool interrupted = false;
    std::string error, pointer;
  };

  /// Works for a case; a call of a plugin's function that takes longer than `budget` ends this process (long_call()).
  Caught watched(double budget, std::uint32_t about, const std::function<void()>& work) {
    Caught caught;
    about_ = about;
    budget_ = budget;
    try {
      work();
    } catch (const Interrupted&) {
      caught.interrupted = true;
    } catch (const InputError& error) {
      caught.error = error.what();
      caught.pointer = error.pointer();
    } catch (const Refusal& refusal) {
      caught.error = refusal.sentence.text;
    } catch (const std::exception& error) {
      caught.error = error.what();
    } catch (...) {
      caught.error = "an exception that carries no message";
    }
    budget_ = std::numeric_limits<double>::infinity();
    return caught;
  }

  /// Ends the process where a call has lasted too long, or does not come back after a stop. Returns what is said of a
  /// call that takes long; "" of others. A reference's own functions have no budget.
  std::string long_call() {
    const std::optional<LongCall> call = calls_.overdue();
    if (stop_ && !stopped_) stopped_ = std::chrono::steady_clock::now();
    if (!stop_) stopped_.reset();
    if (!call || call->seconds <= kLeast) return "";
    const double budget = budget_;
    if (std::isfinite(budget) && call->role != "reference" && call->counted_seconds > std::max(kLeast, budget)) {
      tell({Word::given_up, to_bytes(GivenUp{call->plugin, call->function, budget}), about_});
      ::_exit(kGaveUp);
    }
    if (stopped_ && seconds_since(*stopped_) > kAfterStop) ::_exit(kGaveUp);
    return call->text();
  }

  CaseAnswer answer_to(Word word, const StudyCase& study_case) {
    CaseAnswer answer;
    if (word == Word::plan) {
      answer.seconds = find_kind(study_->kind)->plan(study_case, registry_).predicted_seconds;
    } else if (word == Word::time) {
      const auto timed = cases_.time(study_case, stop_);
      answer.found = timed.has_value();
      if (timed) {
        answer.seconds = timed->marching;
        answer.processor = timed->processor;
      }
    } else {
      answer.record = run_guarded(cases_, study_case, stop_);
    }
    return answer;
  }

  WorkerReady open(const std::string& content) {
    WorkerReady ready;
    try {
      const auto wanted = message_from<WorkerStudy>(content);
      const std::vector<std::filesystem::path> plugins(wanted.plugins.begin(), wanted.plugins.end());
      catalogue_.emplace(standard_catalogue(plugins));
      study_ = parse_study(wanted.study, *catalogue_, registry_);
      identity_.emplace(*study_, registry_);
      for (const StudyCase& one : study_->cases) case_of_.emplace(one.id, &one);
      width_ = wanted.width;
      cases_ = find_kind(study_->kind)
                   ->start({*study_, registry_, [this](const StudyCase& one) { return identity_->of(one); }, this});
      if (cases_.open) cases_.open(checkpoint_store(), stop_);
      ready.identity = identity_->of_all();
      ready.arithmetic = arithmetic_digest();
      memory_allowed = limit_address_space(wanted.memory);
    } catch (const InputError& error) {
      ready.failure = error.what();
      ready.pointer = error.pointer();
    } catch (const std::bad_alloc&) {
      out_of_memory();
    } catch (const std::exception& error) {
      ready.failure = error.what();
    } catch (const Refusal& refusal) {
      ready.failure = refusal.sentence.text;
    }
    return ready;
  }

  CheckpointStore checkpoint_store() {
    CheckpointStore checkpoints;
    checkpoints.find = [this](const std::string& key) { return ask(Word::find, key); };
    checkpoints.keep = [this](const std::string& key, const std::string& content) {
      ask(Word::keep, to_bytes(ShelfMessage{key, content}));
    };
    checkpoints.show = [this](const CaseRecord& record) { tell({Word::show, to_bytes(record)}); };
    checkpoints.failed = [this](const std::string& id) { return !ask(Word::failed, id).empty(); };
    return checkpoints;
  }

  Channel channel_;
  CallWatch calls_{*own_note};  // of the thread that serves
  std::atomic<bool> stop_{false};
  std::optional<std::chrono::steady_clock::time_point> stopped_;  // of the watching thread
  std::atomic<double> budget_{std::numeric_limits<double>::infinity()};
  std::atomic<std::uint32_t> about_{0};
  std::optional<Catalogue> catalogue_;
  Registry registry_;
  std::optional<Study> study_;
  std::optional<StudyIdentity> identity_;
  std::unordered_map<std::string, const StudyCase*> case_of_;  // by id
  CaseRunner cases_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Message> orders_;
  std::map<std::uint32_t, std::promise<std::string>> questions_;
  std::map<std::uint32_t, std::function<void(BlockStatus)>> heard_;  // of blocks that others march for this one
  std::uint32_t asked_ = 0;
  int width_ = 1;
  std::atomic<int> share_{1};
};

}  // namespace

int serve_as_worker() {
  for (const int one : signals_of_coordinator) ::signal(one, SIG_IGN);
  // Held back until now: a plugin finds a mask as usual.
  const sigset_t ignored = coordinator_signals();
  ::pthread_sigmask(SIG_UNBLOCK, &ignored, nullptr);
  own_note = take_note(kWorkerNote);
  note_plugin_calls(own_note);
  memory_allowed = limit_address_space(0);
  std::set_new_handler(out_of_memory);
  std::atexit(on_exit_called);
  std::at_quick_exit(on_exit_called);
  return WorkerService().run();
}

}  // namespace ricochet
