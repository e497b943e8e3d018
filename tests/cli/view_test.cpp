#include <filesystem>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "program.hpp"
#include <samewhere/input/test_folder.hpp>

namespace samewhere::test {
namespace {

class View : public testing::Test {
 protected:
  Outcome run(const std::string& arguments) const { return run_program(arguments, folder_.root()); }
  std::filesystem::path path(const char* name) const { return folder_.root() / name; }

  input::TestFolder folder_;
};

// A port that another program has taken, while this lives.
class TakenPort {
 public:
  TakenPort() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ::bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address));
    ::listen(socket_, 1);
    socklen_t size = sizeof(address);
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    number_ = ntohs(address.sin_port);
  }
  TakenPort(const TakenPort&) = delete;
  TakenPort& operator=(const TakenPort&) = delete;
  ~TakenPort() { ::close(socket_); }
  int number() const { return number_; }

 private:
  int socket_;
  int number_ = 0;
};

constexpr const char* kThreeFrames = "run 'twin:office-loop?seed=2' --set twin.num_frames=3 ";

TEST_F(View, PortThatIsTakenIsBadInputBeforeAnythingIsWritten) {
  const TakenPort taken;
  const Outcome outcome = run(
      fmt::format("{} --out {} --view --at {}", kThreeFrames, quoted(path("run")), taken.number()));
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find(fmt::format("127.0.0.1:{}: cannot be served", taken.number())),
            std::string::npos)
      << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(path("run")));
}

TEST_F(View, RunWithoutAPageEndsByItself) {
  const Outcome outcome =
      run(fmt::format("{} --out {} --view --quiet", kThreeFrames, quoted(path("run"))));
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("look at http://127.0.0.1:"), std::string::npos) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(path("run") / "report.html"));
}

TEST_F(View, OtherMachinesNeedAToken) {
  const Outcome outcome = run(fmt::format("{} --out {} --view --at 0.0.0.0:38471 --quiet",
                                          kThreeFrames, quoted(path("run"))));
  EXPECT_EQ(outcome.exit_code, 0);
  const std::size_t at = outcome.err.find("?token=");
  ASSERT_NE(at, std::string::npos) << outcome.err;
  EXPECT_GE(outcome.err.find('\n', at) - at, 32U);
}

TEST_F(View, BadOptionsAreBadInput) {
  const std::string out = kThreeFrames + std::string("--out ") + quoted(path("run"));
  for (const char* bad :
       {"--view --at 0", "--view --at somewhere:80", "--view --at 99999", "--at 8080",
        "--token secret-token", "--view --token short", "--view --token 'with a space'"}) {
    const Outcome outcome = run(out + " " + bad);
    EXPECT_EQ(outcome.exit_code, 2) << bad;
    EXPECT_FALSE(std::filesystem::exists(path("run"))) << bad;
  }
}

TEST_F(View, MissingRunIsBadInput) {
  const Outcome outcome = run("view " + quoted(path("nowhere")));
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("nowhere/report.html"), std::string::npos) << outcome.err;
  EXPECT_EQ(run("view " + quoted(path("nowhere.sw"))).exit_code, 2);
}

}  // namespace
}  // namespace samewhere::test
