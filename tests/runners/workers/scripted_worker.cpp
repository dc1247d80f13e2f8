#include "tests/runners/workers/scripted_worker.hpp"

#include <chrono>

namespace ricochet::tests {
namespace {

using Word = Message::Word;
using Ends = ScriptedWorld::Ends;

constexpr const char* shared_key = "shared";
constexpr const char* shared_content = "what all cases need";
constexpr int at_one_time = 3;

std::string marched(const std::string& order) {
  return "(" + order + ")";
}

std::string first_block(const std::string& id, int i) {
  return id + "/" + std::to_string(i);
}

std::string last_block(const std::string& id, const std::map<std::string, std::string>& parts) {
  std::string order = id + "/last";
  for (const auto& [block, answer] : parts) order += answer;
  return order;
}

}  // namespace

CaseRecord scripted_row(const std::string& id) {
  std::map<std::string, std::string> parts;
  for (int i = 0; i < at_one_time; ++i) parts[first_block(id, i)] = marched(first_block(id, i));
  CaseRecord row;
  row.status = Status::done;
  row.notes = {shared_content, marched(last_block(id, parts))};
  row.measures = {{"impacts", static_cast<double>(id.back())}};
  return row;
}

bool ScriptedWorker::send(const Message& message) {
  const std::lock_guard guard(mutex_);
  if (!end_.empty()) return false;
  hear(message);
  changed_.notify_all();
  return true;
}

Channel::Heard ScriptedWorker::receive(Message& message, double seconds) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return !said_.empty() || !end_.empty(); });
  if (said_.empty()) return end_.empty() ? Channel::Heard::silence : Channel::Heard::gone;
  message = std::move(said_.front());
  said_.pop_front();
  return Channel::Heard::message;
}

void ScriptedWorker::kill() {
  const std::lock_guard guard(mutex_);
  end_with("signal 9 (killed)");
}

WorkerEnd ScriptedWorker::end() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !end_.empty(); });
  return {.cause = end_};
}

bool ScriptedWorker::ended() {
  const std::lock_guard guard(mutex_);
  return !end_.empty();
}

void ScriptedWorker::end_with(const std::string& cause) {
  if (end_.empty()) end_ = cause;
  changed_.notify_all();
}

void ScriptedWorker::say(Word word, std::string content, std::uint32_t about) {
  said_.push_back({word, std::move(content), about});
}

void ScriptedWorker::hear(const Message& message) {
  if (message.word == Word::study) {
    say(Word::ready, to_bytes(WorkerReady{world_.identity, world_.arithmetic, "", ""}), message.about);
  } else if (message.word == Word::plan) {
    CaseAnswer answer;
    answer.seconds = 1;
    say(Word::planned, to_bytes(answer), message.about);
  } else if (message.word == Word::run) {
    begin_case(message);
  } else if (message.word == Word::block) {
    march(message);
  } else if (message.word == Word::block_status) {
    hear_block(message);
  } else if (message.word == Word::stop && !id_.empty()) {
    id_.clear();
    say(Word::interrupted, "", order_);
  } else if (message.word == Word::answer && !id_.empty()) {
    const auto question = questions_.extract(message.about);
    if (question.empty()) return;
    if (question.mapped() == "find" && message.content.empty()) {
      // Others wait for what it was to keep.
      if (ends_ == Ends::at_its_middle) return end_with("signal 11 (segmentation fault)");
      questions_[++asked_] = "keep";
      return say(Word::keep, to_bytes(ShelfMessage{shared_key, shared_content}), asked_);
    }
    for (int i = 0; i < at_one_time; ++i) begin_block(first_block(id_, i));
  }
}

void ScriptedWorker::begin_case(const Message& order) {
  id_ = message_from<std::vector<CaseOrder>>(order.content).front().id;
  order_ = order.about;
  questions_.clear();
  blocks_.clear();
  parts_.clear();
  lost_.clear();
  ends_ = world_.ends("case " + id_);
  if (ends_ == Ends::at_its_beginning) return end_with("signal 11 (segmentation fault)");
  questions_[++asked_] = "find";
  say(Word::find, shared_key, asked_);
}

void ScriptedWorker::begin_block(const std::string& order) {
  blocks_[++asked_] = order;
  say(Word::march, to_bytes(BlockRequest{id_, order, 0}), asked_);
}

void ScriptedWorker::hear_block(const Message& message) {
  const auto status = message_from<BlockStatus>(message.content);
  if (id_.empty() || blocks_.count(message.about) == 0 || status.what == BlockStatus::What::so_far) return;
  const std::string order = blocks_.extract(message.about).mapped();
  if (status.what == BlockStatus::What::lost && lost_.insert(order).second) return begin_block(order);
  CaseAnswer answer;
  if (status.what != BlockStatus::What::done) {
    answer.record.status = Status::failed;
    answer.record.reasons = {"block " + order + ": " + status.content};
  } else {
    parts_[order] = status.content;
    if (parts_.size() < at_one_time) return;
    if (parts_.size() == at_one_time) return begin_block(last_block(id_, parts_));
    if (ends_ == Ends::at_its_end) return end_with("signal 6 (abort)");
    answer.record.status = Status::done;
    answer.record.notes = {shared_content, status.content};
    answer.record.measures = {{"impacts", static_cast<double>(id_.back())}};
    CaseRecord shown = answer.record;
    shown.id = id_;
    shown.partial = true;
    say(Word::show, to_bytes(shown), 0);
  }
  id_.clear();
  say(Word::ran, to_bytes(answer), order_);
}

void ScriptedWorker::march(const Message& order) {
  const auto request = message_from<BlockRequest>(order.content);
  const Ends ends = world_.ends(request.order);
  if (ends == Ends::at_its_beginning) return end_with("signal 9 (killed)");
  say(Word::block_status, to_bytes(BlockStatus{BlockStatus::What::so_far, "half"}), order.about);
  if (ends != Ends::never) return end_with("exit code 7");
  say(Word::block_status, to_bytes(BlockStatus{BlockStatus::What::done, marched(request.order)}), order.about);
}

}  // namespace ricochet::tests
