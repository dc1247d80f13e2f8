#include "runners/check/guarded_memory.hpp"

#include <fmt/format.h>
#include <setjmp.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <new>
#include <ricochet/contract/plugin_call.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace ricochet::checking {
namespace {

// Reserved on either side of a block, never backed by memory.
constexpr std::size_t moat = std::size_t{16} << 20;
constexpr unsigned char untouched = 0xA5;
constexpr std::size_t looked_at = 512;  // bytes before a block that are compared

thread_local std::vector<const GuardedBlock*> blocks;
thread_local sigjmp_buf way_out;
thread_local bool inside = false;
thread_local const GuardedBlock* touched = nullptr;
thread_local const char* how = nullptr;

struct sigaction handled_before[2];
constexpr int faults[2] = {SIGSEGV, SIGBUS};

extern "C" void ricochet_guard_signal(int signal, siginfo_t* info, void*) {
  if (inside)
    for (const GuardedBlock* block : blocks)
      if (const char* what = block->trespass(info->si_addr)) {
        inside = false;
        touched = block;
        how = what;
        ::siglongjmp(way_out, 1);
      }
  // Of somebody else: it happens again, under the handler that was there.
  ::sigaction(signal, &handled_before[signal == faults[0] ? 0 : 1], nullptr);
}

/// Our handler, as long as it lives.
class Handled {
 public:
  Handled() {
    struct sigaction action = {};
    action.sa_sigaction = ricochet_guard_signal;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_NODEFER;
    ::sigemptyset(&action.sa_mask);
    for (int k = 0; k < 2; ++k) ::sigaction(faults[k], &action, &handled_before[k]);
    inside = true;
  }
  ~Handled() {
    inside = false;
    for (int k = 0; k < 2; ++k) ::sigaction(faults[k], &handled_before[k], nullptr);
  }
  Handled(const Handled&) = delete;
  Handled& operator=(const Handled&) = delete;
};

}  // namespace

GuardedBlock::GuardedBlock(const char* name, std::size_t bytes) : name_(name), bytes_(bytes) {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  page_bytes_ = (bytes + looked_at + page - 1) / page * page;
  reserved_bytes_ = page_bytes_ + 2 * moat;
  void* const made = ::mmap(nullptr, reserved_bytes_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (made == MAP_FAILED) throw std::bad_alloc();
  reserved_ = static_cast<unsigned char*>(made);
  pages_ = reserved_ + moat;
  begin_ = pages_ + page_bytes_ - bytes;
  if (::mprotect(pages_, page_bytes_, PROT_READ | PROT_WRITE) != 0) {
    ::munmap(reserved_, reserved_bytes_);
    throw std::bad_alloc();
  }
  std::fill(begin_ - looked_at, begin_, untouched);
  blocks.push_back(this);
}

GuardedBlock::~GuardedBlock() {
  blocks.erase(std::find(blocks.begin(), blocks.end(), this));
  ::munmap(reserved_, reserved_bytes_);
}

void GuardedBlock::freeze() {
  ::mprotect(pages_, page_bytes_, PROT_READ);
}

bool GuardedBlock::intact() const {
  return std::all_of(begin_ - looked_at, begin_, [](unsigned char byte) { return byte == untouched; });
}

const char* GuardedBlock::trespass(const void* address) const {
  const auto* at = static_cast<const unsigned char*>(address);
  if (at < reserved_ || at >= reserved_ + reserved_bytes_) return nullptr;
  if (at >= begin_ + bytes_) return "reaches beyond the end of";
  return at < begin_ ? "reaches before the beginning of" : "writes into, which it may only read,";
}

void call_guarded(const std::function<void()>& call) {
  // What the call left behind is undone by this scope.
  const PluginCall before = current_plugin_call();
  const PluginIdentity nobody;
  const PluginCallScope scope(before.plugin ? *before.plugin : nobody, before.plugin ? before.function : "");
  touched = nullptr;
  {
    const Handled handled;
    if (::sigsetjmp(way_out, 0) == 0) call();
  }
  const char* what = touched ? how : nullptr;
  const GuardedBlock* block = touched;
  for (const GuardedBlock* one : blocks)
    if (!block && !one->intact()) {
      block = one;
      what = "writes before the beginning of";
    }
  if (block) throw std::runtime_error(fmt::format("{} the array `{}` that it is given", what, block->name()));
}

}  // namespace ricochet::checking
