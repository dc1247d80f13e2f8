#pragma once
#include <functional>
#include <ricochet/contract/plugin_call.hpp>
#include <string>

namespace ricochet {

/// How work in a child process ended, and what it left.
struct ChildOutcome {
  enum class End { value, exception, signal, exit, timeout };
  End end = End::value;
  std::string text;  ///< what the work returned, or what its exception says
  int number = 0;    ///< the signal, or the exit code
  double limit = 0;  ///< s, that it did not keep
  /// What it asked of a plugin when a signal, an exit or the limit ended it; "" where that was nothing.
  PluginIdentity plugin;
  std::string function;

  bool ok() const { return end == End::value; }
  /// "ended by signal 11 (segmentation fault)", "ended the process with exit code 7", "did not end within 10 s", or the
  /// text of the exception.
  std::string cause() const;
  /// The cause, with plugin, file and function before it where they are known: "plugin time 'x' (x.so), plan(): ended
  /// …".
  std::string sentence() const;
};

/// Runs `work` in a child process and waits for it, at most `seconds` long. Whatever a plugin does there (abort, exit,
/// write where it must not, never return), this process stays as it was. The child writes nothing to the streams of
/// this process and leaves no core file. Throws std::runtime_error when no process can be had.
/// `waits` is called in this process, once, where the work lasts longer than some seconds.
ChildOutcome run_in_child(const std::function<std::string()>& work, double seconds,
                          const std::function<void()>& waits = {});

}  // namespace ricochet
