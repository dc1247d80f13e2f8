#pragma once
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "runners/march/block_service.hpp"
#include "runners/store/record.hpp"
#include "runners/study/study.hpp"

namespace ricochet {

/// What outlives the program of a case under way and of what cases share: find(key) gives what keep(key, content) once
/// stored, or "".
struct CheckpointStore {
  std::function<std::string(const std::string& key)> find;
  std::function<void(const std::string& key, const std::string& content)> keep;
  /// Shows what a case under way has so far; empty where nobody looks.
  std::function<void(const CaseRecord&)> show;
  /// Whether a case has failed: nothing is computed with its methods for others.
  std::function<bool(const std::string& id)> failed;
  /// Told which call of a plugin's function a case waits for, in words; "" once it no longer does.
  std::function<void(const std::string& id, const std::string& call)> waiting = {};
};

/// What `read` makes of what is kept under the key; nothing where nothing is, or where it is not whole or of another
/// version: what was stored is there to save time, and is computed again.
template <class T>
std::optional<T> recall(const CheckpointStore& checkpoints, const std::string& key,
                        T (*read)(const std::string& bytes)) {
  const std::string bytes = checkpoints.find ? checkpoints.find(key) : "";
  if (bytes.empty()) return std::nullopt;
  try {
    return read(bytes);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

/// Where a case keeps what would be lost if it were killed, and says how far it is.
struct CaseContext {
  CheckpointStore checkpoints;     ///< bytes by key; empty bytes forget a key
  std::string key;                 ///< of this case and everything its bits depend on
  BlockService* blocks = nullptr;  ///< other processes that march for it; null: it marches itself
};

}  // namespace ricochet
