#include <algorithm>
#include <cstring>
#include <ricochet/contract/plugin_call.hpp>

namespace ricochet {
namespace {

// constinit and trivially destructible: there before and after everything else.
constinit thread_local PluginCall call;
constinit thread_local std::uint64_t calls = 0;
constinit thread_local CallNote* note = nullptr;
// What the note's texts say.
constinit thread_local std::uint64_t noted_plugin = 0;
constinit thread_local const char* noted_function = nullptr;

void write_note() {
  if (!call.plugin) return note->returned();
  note->write(call, call.plugin->number != noted_plugin, call.function != noted_function);
  noted_plugin = call.plugin->number;
  noted_function = call.function;
}

}  // namespace

std::uint64_t PluginIdentity::next() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

std::string PluginIdentity::text() const {
  return role + " '" + name + "'" + (file.empty() ? "" : " (" + file + ")");
}

const PluginCall& current_plugin_call() {
  return call;
}

std::string SeenCall::place() const {
  if (function.empty()) return "";
  return "plugin " + plugin.text() + (serial == 0 ? ", after " : ", ") + function + "(): ";
}

template <std::size_t words>
void SharedText<words>::store(std::string_view text) {
  constexpr std::size_t bytes = sizeof(std::uint64_t);
  text = text.substr(0, words * bytes - 1);
  for (std::size_t i = 0; i < words; ++i) {
    std::uint64_t word = 0;
    if (i * bytes < text.size()) std::memcpy(&word, text.data() + i * bytes, std::min(bytes, text.size() - i * bytes));
    words_[i].store(word, std::memory_order_relaxed);
    if (i * bytes >= text.size()) return;  // the rest is not read
  }
}

template <std::size_t words>
std::string SharedText<words>::load() const {
  std::array<char, words * sizeof(std::uint64_t) + 1> text{};
  for (std::size_t i = 0; i < words; ++i) {
    const std::uint64_t word = words_[i].load(std::memory_order_relaxed);
    std::memcpy(text.data() + i * sizeof word, &word, sizeof word);
  }
  return text.data();
}

void CallNote::write(const PluginCall& one, bool of_another_plugin, bool of_another_function) {
  const std::uint64_t version = version_.load(std::memory_order_relaxed);
  version_.store(version + 1, std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_release);
  if (of_another_plugin) {
    role_.store(one.plugin->role);
    name_.store(one.plugin->name);
    file_.store(one.plugin->file);
  }
  if (of_another_function) function_.store(one.function);
  serial_.store(one.serial, std::memory_order_relaxed);
  version_.store(version + 2, std::memory_order_release);
}

SeenCall CallNote::seen() const {
  constexpr int trials = 1000;  // a writer that ended while it wrote never ends writing
  SeenCall seen;
  for (int trial = 0; trial < trials; ++trial) {
    const std::uint64_t version = version_.load(std::memory_order_acquire);
    seen = {{role_.load(), name_.load(), file_.load()}, function_.load(), serial_.load(std::memory_order_relaxed)};
    std::atomic_thread_fence(std::memory_order_acquire);
    if (version % 2 == 0 && version_.load(std::memory_order_relaxed) == version) break;
  }
  return seen;
}

void note_plugin_calls(CallNote* where) {
  note = where;
  noted_plugin = 0;
  noted_function = nullptr;
  if (note) write_note();
}

PluginCallScope::PluginCallScope(const PluginIdentity& plugin, const char* function) : before_(call) {
  call = {&plugin, function, ++calls};
  if (note) write_note();
}
PluginCallScope::~PluginCallScope() {
  call = before_;
  if (note) write_note();
}

PluginFault::PluginFault(const PluginIdentity& plugin, const char* function, const std::string& what)
    : std::runtime_error("plugin " + plugin.text() + ", " + function + "(): " + cut_short(what)) {}

}  // namespace ricochet
