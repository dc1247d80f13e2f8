#include "tests/runners/mpi/cluster.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <random>

namespace launch {

using namespace std::string_literals;

namespace {

namespace fs = std::filesystem;

constexpr int tries = 1000;
constexpr useconds_t between = 20000;

/// Ports on which nobody listens.
std::vector<int> free_ports(int count) {
  std::vector<int> ports, held;
  for (int i = 0; i < count; ++i) {
    const int descriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    ::bind(descriptor, reinterpret_cast<sockaddr*>(&address), size);
    ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size);
    ports.push_back(ntohs(address.sin_port));
    held.push_back(descriptor);
  }
  for (const int descriptor : held) ::close(descriptor);
  return ports;
}

std::string short_name() {
  std::array<char, 256> text{};
  ::gethostname(text.data(), text.size() - 1);
  const std::string name = text.data();
  return name.substr(0, name.find('.'));
}

std::string configuration(const std::string& folder, const std::vector<int>& ports) {
  return fmt::format(R"(ClusterName=ci
SlurmctldHost={host}(127.0.0.1)
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmctldPort={controller}
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CryptoType=crypto/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool.%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.%n.log
TmpFS={folder}/tmp.%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
ReturnToService=2
SlurmdParameters=config_overrides
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
SlurmdTimeout=10
KillWait=5
JobRequeue=1
MailProg=/bin/true
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={first} CPUs=2 State=UNKNOWN
NodeName=n2 NodeHostname={host} NodeAddr=127.0.0.1 Port={second} CPUs=2 State=UNKNOWN
PartitionName=ci Nodes=ALL Default=YES MaxTime=INFINITE State=UP
)",
                     fmt::arg("host", short_name()), fmt::arg("folder", folder), fmt::arg("controller", ports[0]),
                     fmt::arg("first", ports[1]), fmt::arg("second", ports[2]));
}

}  // namespace

Cluster::Cluster() {
  start();
}

Cluster::~Cluster() {
  if (failure_.empty()) answer("scancel --user=root --signal=KILL --full; sleep 0.2; scancel --user=root");
  for (const char* node : {"n1", "n2"}) cut_off(node);
  for (const std::string& file : pid_files_)
    if (const std::string text = read_text(file); !text.empty()) ::kill(std::atoi(text.c_str()), SIGKILL);
  for (const pid_t one : processes_with("")) ::kill(one, SIGKILL);
}

bool Cluster::daemon(const std::string& words, const std::string& pid_file) {
  const std::string log = (scratch_ / "started").string();
  if (std::system((line(words) + " >'" + log + "' 2>&1").c_str()) != 0) {
    failure_ = words.substr(0, words.find(' ')) + " does not start: " + read_text(log);
    return false;
  }
  pid_files_.push_back((scratch_ / pid_file).string());
  return true;
}

void Cluster::start() {
  const std::string folder = scratch_.path().string();
  for (const char* name : {"state", "spool.n1", "spool.n2", "tmp.n1", "tmp.n2"}) fs::create_directory(scratch_ / name);
  fs::permissions(scratch_.path(), fs::perms::owner_all | fs::perms::group_exec | fs::perms::others_exec);
  write_text(scratch_ / "slurm.conf", configuration(folder, free_ports(3)));
  // Where this process is killed, its daemons go as well.
  const std::string watch = fmt::format(
      "setsid sh -c 'while kill -0 {0} && [ -d {1} ]; do sleep 1; done; [ -d {1} ] && kill -9 $(cat {1}/*.pid) && rm "
      "-r {1}' >/dev/null 2>&1 &",
      ::getpid(), folder);
  static_cast<void>(!std::system(watch.c_str()));
  std::string key(1024, '\0');
  std::random_device luck;
  for (char& one : key) one = static_cast<char>(luck());
  write_text(scratch_ / "munge.key", key);
  fs::permissions(scratch_ / "munge.key", fs::perms::owner_read | fs::perms::owner_write);
  if (!daemon(fmt::format("munged --force --key-file={0}/munge.key --socket={0}/munge.socket --pid-file={0}/munge.pid "
                          "--log-file={0}/munge.log --seed-file={0}/munge.seed",
                          folder),
              "munge.pid") ||
      !daemon("slurmctld", "slurmctld.pid") || !daemon("slurmd -N n1", "slurmd.n1.pid") ||
      !daemon("slurmd -N n2", "slurmd.n2.pid"))
    return;
  for (int i = 0; i < tries; ++i, ::usleep(between))
    if (rests()) return;
  failure_ = "the nodes of the cluster do not come up: " + answer("sinfo") + read_text(scratch_ / "slurmd.n1.log");
}

std::string Cluster::line(const std::string& words) const {
  // Ranks of the two nodes share this machine's memory, and must not know it.
  return "env SLURM_CONF='" + (scratch_ / "slurm.conf").string() +
         "' OMPI_MCA_btl=tcp,self OMPI_MCA_btl_tcp_if_include=lo PATH=$PATH:/usr/sbin sh -c '" + words + "'";
}

std::string Cluster::answer(const std::string& words) const {
  const std::string file = (scratch_ / "answer").string();
  return std::system((line(words) + " >'" + file + "' 2>&1").c_str()) == -1 ? "" : read_text(file);
}

bool Cluster::rests() const {
  return answer("sinfo -h -o %T:%D") == "idle:2\n";
}

std::string Cluster::submit(const std::string& script) const {
  write_text(scratch_ / "job.sh", script);
  const std::string said =
      answer(fmt::format("sbatch --parsable --output={0}/job.out {0}/job.sh", scratch_.path().string()));
  INFO(said);
  REQUIRE_FALSE(said.empty());
  REQUIRE(said.find_first_not_of("0123456789\n") == std::string::npos);
  return said.substr(0, said.find('\n'));
}

std::string Cluster::of_job(const std::string& job, const std::string& key) const {
  const std::string said = answer("scontrol show job " + job);
  const std::size_t at = said.find(" " + key + "=");
  if (at == std::string::npos) return "";
  const std::size_t begin = at + key.size() + 2;
  return said.substr(begin, said.find_first_of(" \n", begin) - begin);
}

std::vector<pid_t> Cluster::processes_with(const std::string& word) const {
  std::vector<pid_t> found = processes("");
  std::erase_if(found, [&](pid_t one) {
    const std::string environment = "\0"s + read_text("/proc/" + std::to_string(one) + "/environ");
    return environment.find(scratch_.path().string() + "/slurm.conf") == std::string::npos ||
           environment.find("\0"s + word) == std::string::npos;
  });
  return found;
}

void Cluster::cut_off(const std::string& node) const {
  if (const std::string text = read_text(scratch_ / ("slurmd." + node + ".pid")); !text.empty())
    ::kill(std::atoi(text.c_str()), SIGKILL);
  const std::vector<pid_t> ranks = processes_with("SLURMD_NODENAME=" + node);
  for (const pid_t one : ranks)
    if (const pid_t parent = parent_of(one); read_text("/proc/" + std::to_string(parent) + "/comm") == "slurmstepd\n")
      ::kill(parent, SIGKILL);
  for (const pid_t one : ranks) ::kill(one, SIGKILL);
}

void Cluster::switch_on(const std::string& node) const {
  for (const char* folder : {"tmp.", "spool."}) {
    fs::remove_all(scratch_ / (folder + node));
    fs::create_directory(scratch_ / (folder + node));
  }
  answer("slurmd -N " + node);
}

}  // namespace launch
