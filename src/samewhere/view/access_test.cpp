#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/view/access.hpp>

namespace samewhere::view {
namespace {

Caller page_of(const std::string& host) { return {.host = host, .is_page = true}; }

TEST(Access, AnswersItsOwnAddressAlone) {
  const Access access({"127.0.0.1", 8080}, "");
  EXPECT_FALSE(access.refusal(page_of("127.0.0.1:8080")));
  EXPECT_FALSE(access.refusal(page_of("localhost:8080")));
  // a name that its owner lets point to this machine (DNS rebinding)
  for (const char* other :
       {"evil.example:8080", "127.0.0.1:8081", "127.0.0.1", "", "10.0.0.1:8080"})
    EXPECT_TRUE(access.refusal(page_of(other))) << other;
}

TEST(Access, AnswersAnyNumberOfTheMachineWhereItIsServedEverywhere) {
  const Access access({"0.0.0.0", 8080}, "0123456789");
  Caller caller = page_of("192.168.1.7:8080");
  caller.token = "0123456789";
  EXPECT_FALSE(access.refusal(caller));
  caller.host = "evil.example:8080";
  EXPECT_TRUE(access.refusal(caller));
  caller.host = "[fe80::1]:8080";
  EXPECT_FALSE(access.refusal(caller));
}

TEST(Access, RefusesOtherSites) {
  const Access access({"127.0.0.1", 8080}, "");
  const std::string host = "127.0.0.1:8080";
  EXPECT_FALSE(access.refusal({.host = host, .origin = "http://127.0.0.1:8080"}));
  EXPECT_FALSE(access.refusal({.host = host, .fetch_site = "same-origin"}));
  EXPECT_TRUE(access.refusal({.host = host, .origin = "http://evil.example"}));
  EXPECT_TRUE(access.refusal({.host = host, .origin = "null"}));
  EXPECT_TRUE(access.refusal({.host = host, .fetch_site = "cross-site"}));
  EXPECT_TRUE(access.refusal({.host = host, .fetch_site = "same-site"}));
  // a link on another site
  EXPECT_FALSE(access.refusal({.host = host, .fetch_site = "cross-site", .is_page = true}));
}

TEST(Access, AsksForTheToken) {
  const Access access({"0.0.0.0", 8080}, "0123456789");
  Caller caller = page_of("10.0.0.1:8080");
  for (const char* wrong : {"", "0", "0123456780", "01234567890", "01234567890123456789"}) {
    caller.token = wrong;
    EXPECT_TRUE(access.refusal(caller)) << wrong;
  }
  caller.token = "0123456789";
  EXPECT_FALSE(access.refusal(caller));
}

TEST(Access, NeedsATokenForOtherMachines) {
  EXPECT_THROW(Access({"0.0.0.0", 8080}, ""), core::ContractError);
}

TEST(Place, IsReadFromAPortOrAnAddress) {
  EXPECT_FALSE(parse_place("any", "--view").is_port_wanted);
  EXPECT_EQ(parse_place("9000", "--view").port, 9000);
  EXPECT_EQ(host_of(parse_place("0.0.0.0:9000", "--view")), "0.0.0.0:9000");
  EXPECT_EQ(host_of(parse_place("[::1]:9000", "--view")), "[::1]:9000");
  EXPECT_TRUE(is_on_this_machine(parse_place("[::1]:9000", "--view")));
  EXPECT_FALSE(is_on_this_machine(parse_place("0.0.0.0:9000", "--view")));
  for (const char* bad : {"", "0", "65536", "-1", "80x", "host:80", "1.2.3:80", ":", "1.2.3.4:"})
    EXPECT_THROW(parse_place(bad, "--view"), core::InputError) << bad;
}

TEST(Place, RandomTokensDiffer) {
  EXPECT_EQ(random_token().size(), 32U);
  EXPECT_NE(random_token(), random_token());
}

}  // namespace
}  // namespace samewhere::view
