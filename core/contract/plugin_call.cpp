#include <algorithm>
#include <cstring>
#include <ricochet/contract/plugin_call.hpp>

namespace ricochet {
namespace {

// What the slots of the note say. A slot is used again where there are more than it has.
template <class Key, std::size_t slots>
struct Slots {
  std::array<Key, slots> keys{};
  std::size_t last = 0, next = 0;

  /// The slot of the key; `name` is called for one that is new.
  template <class Name>
  std::size_t of(Key key, Name name) {
    if (keys[last] == key) return last;
    for (last = 0; last < slots; ++last)
      if (keys[last] == key) return last;
    last = next;
    next = (next + 1) % slots;
    keys[last] = key;
    name(last);
    return last;
  }
};
// All of a thread, in one place: it is found once for each call.
struct OfThread {
  PluginCall call;
  std::uint64_t calls = 0;
  CallNote* note = nullptr;
  Slots<std::uint64_t, CallNote::plugins> plugins;
  Slots<const char*, CallNote::functions> functions;
  CallNote::Word noted;
};
// constinit and trivially destructible: there before and after everything else.
[[gnu::tls_model("initial-exec")]] constinit thread_local OfThread of_thread;

void write_note(OfThread& mine) {
  const PluginCall& call = mine.call;
  if (call.plugin) {
    mine.noted.serial = call.serial;
    mine.noted.plugin =
        mine.plugins.of(call.plugin->number, [&](std::size_t slot) { mine.note->name_plugin(slot, *call.plugin); });
    mine.noted.function =
        mine.functions.of(call.function, [&](std::size_t slot) { mine.note->name_function(slot, call.function); });
  }
  mine.noted.under_way = call.plugin != nullptr;
  mine.note->write(mine.noted);
}

// From the lowest bit: whether it is under way, the slots, the serial number.
constexpr unsigned function_at = 1, plugin_at = 9, serial_at = 17;
constexpr std::uint64_t slot_mask = 0xFF;

}  // namespace

std::uint64_t PluginIdentity::next() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

std::string PluginIdentity::text() const {
  return role + " '" + name + "'" + (file.empty() ? "" : " (" + file + ")");
}

const PluginCall& current_plugin_call() {
  return of_thread.call;
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

std::uint64_t CallNote::Word::packed() const {
  return serial << serial_at | plugin << plugin_at | function << function_at | std::uint64_t{under_way};
}

CallNote::Word CallNote::Word::of(std::uint64_t packed) {
  return {packed >> serial_at, packed >> plugin_at & slot_mask, packed >> function_at & slot_mask, (packed & 1U) != 0};
}

void CallNote::name_plugin(std::size_t slot, const PluginIdentity& plugin) {
  plugins_[slot].role.store(plugin.role);
  plugins_[slot].name.store(plugin.name);
  plugins_[slot].file.store(plugin.file);
}

SeenCall CallNote::seen() const {
  constexpr int trials = 100;  // of a thread that calls without a pause any call may be told
  SeenCall seen;
  std::uint64_t before = word_.load(std::memory_order_acquire);
  for (int trial = 0; trial < trials; ++trial) {
    const Word word = Word::of(before);
    if (word.serial == 0) return {};
    const Plugin& plugin = plugins_[word.plugin % plugins];
    seen = {{plugin.role.load(), plugin.name.load(), plugin.file.load()},
            functions_[word.function % functions].load(),
            word.under_way ? word.serial : 0};
    std::atomic_thread_fence(std::memory_order_acquire);
    const std::uint64_t now = word_.load(std::memory_order_relaxed);
    if (now == before) break;
    before = now;
  }
  return seen;
}

void note_plugin_calls(CallNote* where) {
  OfThread& mine = of_thread;
  mine.note = where;
  mine.plugins = {};
  mine.functions = {};
  mine.noted = {};
  if (where) write_note(mine);
}

PluginCallScope::PluginCallScope(const PluginIdentity& plugin, const char* function) : before_(of_thread.call) {
  OfThread& mine = of_thread;
  mine.call = {&plugin, function, ++mine.calls};
  if (mine.note) write_note(mine);
}
PluginCallScope::~PluginCallScope() {
  OfThread& mine = of_thread;
  mine.call = before_;
  if (mine.note) write_note(mine);
}

PluginFault::PluginFault(const PluginIdentity& plugin, const char* function, const std::string& what)
    : std::runtime_error("plugin " + plugin.text() + ", " + function + "(): " + one_line(what)) {}

}  // namespace ricochet
