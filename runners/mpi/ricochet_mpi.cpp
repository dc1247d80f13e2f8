/// `ricochet run` with workers on all machines of a job: one rank for each machine, rank 0 the only one that opens the
/// store. All that is known of MPI stands here: its point-to-point calls alone, from one thread.
#include <mpi.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstring>
#include <deque>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "runners/mpi/ranks.hpp"
#include "runners/workers/machines.hpp"
#include "runners/workers/worker_process.hpp"

namespace ricochet {
namespace {

// Packets for one rank travel together, in pieces of a stream.
constexpr std::size_t most_of_a_piece = std::size_t{16} << 20;
constexpr int tag = 17;
// Between two calls of MPI, which says nothing by itself: shortly after something came, and later.
constexpr std::chrono::microseconds short_nap{100}, long_nap{1000};
constexpr auto busy_for = std::chrono::milliseconds(5);

using Clock = std::chrono::steady_clock;

class MpiTransport : public Transport {
 public:
  MpiTransport() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    // A rank that is gone is noticed by its silence.
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    pump_ = std::thread([this] { pump(); });
  }
  ~MpiTransport() override {
    end(0);
    pump_.join();
  }

  /// Waits until what was sent is on its way, so many s at most, and sends and receives nothing more. False where it is
  /// not: nobody takes it any more.
  bool end(double seconds) {
    std::unique_lock lock(mutex_);
    ending_ = true;
    to_send_.notify_all();
    const bool all = ended_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return done_; });
    abandons_ = true;
    return all;
  }

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  void send(int to, std::string bytes) override {
    const std::lock_guard guard(mutex_);
    std::string& stream = outgoing_[to];
    const std::uint64_t count = bytes.size();
    stream.append(reinterpret_cast<const char*>(&count), sizeof(count));
    stream += bytes;
    to_send_.notify_all();
  }

  std::optional<Packet> receive(double seconds) override {
    std::unique_lock lock(mutex_);
    if (!arrived_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return !incoming_.empty(); }))
      return std::nullopt;
    Packet packet = std::move(incoming_.front());
    incoming_.pop_front();
    return packet;
  }

 private:
  /// A piece on its way to a rank; its bytes stay until MPI is done with them.
  struct Sending {
    std::string piece;
    MPI_Request request = MPI_REQUEST_NULL;
  };

  void pump() {
    auto last = Clock::now();
    for (;;) {
      bool moved = send_pieces();
      moved = receive_pieces() || moved;
      if (moved) last = Clock::now();
      std::unique_lock lock(mutex_);
      if (abandons_ || (ending_ && outgoing_.empty() && sending_.empty())) {
        done_ = true;
        ended_.notify_all();
        return;
      }
      if (!moved) to_send_.wait_for(lock, Clock::now() - last < busy_for ? short_nap : long_nap);
    }
  }

  bool send_pieces() {
    bool moved = false;
    std::vector<int> ready;
    {
      const std::lock_guard guard(mutex_);
      for (auto& [to, stream] : outgoing_) {
        if (sending_.count(to)) continue;
        sending_[to].piece = stream.substr(0, most_of_a_piece);
        stream.erase(0, most_of_a_piece);
        ready.push_back(to);
      }
      std::erase_if(outgoing_, [](const auto& one) { return one.second.empty(); });
    }
    for (const int to : ready) {
      Sending& one = sending_[to];
      MPI_Isend(one.piece.data(), static_cast<int>(one.piece.size()), MPI_BYTE, to, tag, MPI_COMM_WORLD, &one.request);
    }
    for (auto one = sending_.begin(); one != sending_.end();) {
      int done = 0;
      // An error means that nobody is there any more.
      if (MPI_Test(&one->second.request, &done, MPI_STATUS_IGNORE) != MPI_SUCCESS) done = 1;
      moved = moved || done;
      one = done ? sending_.erase(one) : std::next(one);
    }
    return moved;
  }

  bool receive_pieces() {
    int there = 0;
    MPI_Status status;
    if (MPI_Iprobe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &there, &status) != MPI_SUCCESS || !there) return false;
    int count = 0;
    MPI_Get_count(&status, MPI_BYTE, &count);
    const int from = status.MPI_SOURCE;
    std::string& stream = received_[from];
    const std::size_t before = stream.size();
    stream.resize(before + static_cast<std::size_t>(count));
    if (MPI_Recv(stream.data() + before, count, MPI_BYTE, from, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE) !=
        MPI_SUCCESS) {
      stream.resize(before);
      return false;
    }
    std::size_t at = 0;
    for (std::uint64_t length = 0; stream.size() - at >= sizeof(length); at += sizeof(length) + length) {
      std::memcpy(&length, stream.data() + at, sizeof(length));
      if (stream.size() - at - sizeof(length) < length) break;
      const std::lock_guard guard(mutex_);
      incoming_.push_back({from, stream.substr(at + sizeof(length), length)});
      arrived_.notify_one();
    }
    stream.erase(0, at);
    return true;
  }

  int rank_ = 0, size_ = 1;
  std::mutex mutex_;
  std::condition_variable to_send_, arrived_, ended_;
  std::map<int, std::string> outgoing_;
  std::deque<Packet> incoming_;
  bool ending_ = false, abandons_ = false, done_ = false;
  // Of the pump alone.
  std::map<int, Sending> sending_;
  std::map<int, std::string> received_;
  std::thread pump_;
};

}  // namespace
}  // namespace ricochet

int main(int argc, char** argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  if (provided < MPI_THREAD_SERIALIZED) {
    std::cerr << "ricochet: this MPI cannot be called from a thread of its own (MPI_THREAD_SERIALIZED)\n";
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  int code = 0;
  bool lost = false;
  {
    ricochet::MpiTransport transport;
    // Launchers signal all ranks; rank 0 stops the run and then sends the agents home.
    if (transport.rank() != 0)
      for (const int one : ricochet::signals_of_coordinator) ::signal(one, SIG_IGN);
    code = ricochet::run_rank(transport, {argv + std::min(argc, 1), argv + argc}, std::cout, std::cerr, lost);
    // MPI_Finalize is no place to meet: under srun with PMIx it may let one go to whom others still speak.
    if (!lost && !transport.end(ricochet::lost_after)) {
      std::cerr << "ricochet: rank " << transport.rank() << ": nobody takes what it has said\n";
      code = std::max(code, 1);
      lost = true;
    }
    if (lost) {
      std::cout.flush();
      std::cerr.flush();
      MPI_Abort(MPI_COMM_WORLD, code);
    }
  }
  MPI_Finalize();
  return code;
}
