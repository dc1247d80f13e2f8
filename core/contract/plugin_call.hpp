#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <ricochet/contract/errors.hpp>
#include <string>
#include <string_view>

namespace ricochet {

/// Who provides the code that is about to run: "time 'bathe' (/path/time.so)".
struct PluginIdentity {
  std::string role, name, file;   ///< file: "" when registered in-process
  std::uint64_t number = next();  ///< of one identity and its copies alone
  std::string text() const;

 private:
  static std::uint64_t next();
};

/// What this thread asks of a plugin right now.
struct PluginCall {
  const PluginIdentity* plugin = nullptr;
  const char* function = nullptr;  ///< "plan", "solve", "build", …: a literal
  std::uint64_t serial = 0;        ///< of this thread's calls: equal at two moments, the call never returned between
};

/// The call under way in this thread; `plugin` is null between calls.
const PluginCall& current_plugin_call();

/// A call as another thread or process sees it.
struct SeenCall {
  PluginIdentity plugin;
  std::string function;      ///< "": no call was seen
  std::uint64_t serial = 0;  ///< 0: it has returned, and none is under way
  /// "plugin time 'x' (x.so), plan(): "; of one that has returned "plugin time 'x' (x.so), after plan(): "; "" of none.
  std::string place() const;
};

/// A text of at most so many words of 8 bytes. It may be read while it is written: then it may be torn.
template <std::size_t words>
class SharedText {
 public:
  void store(std::string_view text);
  std::string load() const;

 private:
  std::array<std::atomic<std::uint64_t>, words> words_{};
};

/// The calls of one thread, written where another thread or process may read them, whatever becomes of the thread.
/// Zeros are a note without a call. A reader believes none of it: what shares the memory may have damaged it. A call
/// costs its writer one word: plugins and functions have their texts in slots, written when they are first met.
class CallNote {
 public:
  static constexpr std::size_t plugins = 8, functions = 32;
  /// A call, in one word; that of serial 0 is none.
  struct Word {
    std::uint64_t serial = 0;
    std::size_t plugin = 0, function = 0;  ///< slots
    bool under_way = false;
    std::uint64_t packed() const;
    static Word of(std::uint64_t packed);
  };
  /// The last call that began.
  SeenCall seen() const;
  void write(Word word) { word_.store(word.packed(), std::memory_order_release); }
  void name_plugin(std::size_t slot, const PluginIdentity& plugin);
  void name_function(std::size_t slot, const char* function) { functions_[slot].store(function); }
  /// Bytes that the process may take, where it ended itself for want of more; 0 elsewhere.
  std::atomic<std::uint64_t> memory_exceeded{0};
  /// The process ended because exit() was called in it.
  std::atomic<bool> exit_called{false};

 private:
  struct Plugin {
    SharedText<4> role;
    SharedText<16> name;
    SharedText<128> file;
  };
  std::atomic<std::uint64_t> word_{0};
  std::array<Plugin, plugins> plugins_;
  std::array<SharedText<4>, functions> functions_;
};

/// From now on this thread writes its calls to the note; null: nowhere.
void note_plugin_calls(CallNote* note);

/// Marks this thread as being inside a plugin's function for as long as it lives; scopes nest.
class PluginCallScope {
 public:
  PluginCallScope(const PluginIdentity& plugin, const char* function);
  ~PluginCallScope();
  PluginCallScope(const PluginCallScope&) = delete;
  PluginCallScope& operator=(const PluginCallScope&) = delete;

 private:
  PluginCall before_;
};

/// A plugin did what the contract forbids: threw, returned nothing, sizes that do not fit, numbers that are none. The
/// message names plugin, file and function; what the plugin says is cut at `longest_text` bytes. A case that meets one
/// is `failed`, never `refused`.
class PluginFault : public std::runtime_error {
 public:
  PluginFault(const PluginIdentity& plugin, const char* function, const std::string& what);
};

}  // namespace ricochet
