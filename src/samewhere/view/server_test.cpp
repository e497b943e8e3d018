#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/view/server.hpp>
#include <samewhere/view/test_client.hpp>

namespace samewhere::view {
namespace {

constexpr Place kAnyPort{};

// A page, a stream that counts or, with `bulk`, never ends quickly, and an action that repeats.
Routes test_routes(std::size_t bulk = 0) {
  Routes routes;
  routes.pages["/"] = [] { return std::make_shared<const std::string>("<p>page</p>"); };
  routes.streams["/events"] = [bulk] {
    return [bulk, num = 0]() mutable -> std::optional<std::string> {
      return "data: " + std::to_string(num++) + std::string(bulk, 'x') + "\n\n";
    };
  };
  routes.actions["/act"] = [](const std::string& body) {
    if (body == "bad") throw core::InputError("expected good");
    return Answer{200, body};
  };
  return routes;
}

TEST(Server, ServesItsPathsAndNothingElse) {
  const Server server(kAnyPort, "", test_routes());
  const int port = server.port();
  EXPECT_NE(ask(port, "GET /").find("<p>page</p>"), std::string::npos);
  for (const char* path : {"/etc/passwd", "/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd",
                           "//etc/passwd", "/act", "/index.html"})
    EXPECT_EQ(status_of(ask(port, std::string("GET ") + path)), 404) << path;
  EXPECT_EQ(status_of(post(port, "/", "{}")), 404);
}

TEST(Server, AnswersActionsInJsonAlone) {
  const Server server(kAnyPort, "", test_routes());
  EXPECT_TRUE(post(server.port(), "/act", "{\"a\":1}").ends_with("\r\n\r\n{\"a\":1}"));
  const std::string refused = post(server.port(), "/act", "bad");
  EXPECT_EQ(status_of(refused), 400);
  EXPECT_TRUE(refused.ends_with("expected good"));
  // what a form of another site can send without asking
  EXPECT_EQ(status_of(post(server.port(), "/act", "a=1", "Content-Type: text/plain\r\n")), 415);
}

TEST(Server, RefusesOtherSitesAndWrongTokens) {
  const Server server(kAnyPort, "secret-token", test_routes());
  const int port = server.port();
  EXPECT_TRUE(server.url().ends_with("/?token=secret-token"));
  EXPECT_EQ(status_of(ask(port, "GET /")), 403);
  EXPECT_EQ(status_of(ask(port, "GET /?token=secret-tokem")), 403);
  EXPECT_EQ(status_of(ask(port, "GET /?token=secret-token")), 200);
  EXPECT_EQ(status_of(ask(port, "GET /?token=secret-token", "Host: evil.example\r\n")), 403);
  EXPECT_EQ(
      status_of(ask(port, "GET /events?token=secret-token", "Origin: http://evil.example\r\n")),
      403);
  EXPECT_EQ(
      status_of(ask(port, "GET /events?token=secret-token", "Sec-Fetch-Site: cross-site\r\n")),
      403);
  EXPECT_EQ(status_of(post(port, "/act", "{}")), 403);
}

TEST(Server, RefusesHugeRequests) {
  const Server server(kAnyPort, "", test_routes());
  const int port = server.port();
  EXPECT_EQ(status_of(ask(port, "GET /" + std::string(20'000, 'a'))), 431);
  EXPECT_EQ(status_of(ask(port, "GET /", "X: " + std::string(20'000, 'a') + "\r\n")), 431);
  EXPECT_EQ(status_of(ask(port, "POST /act", "Content-Length: 1000000000\r\n")), 413);
  // headers without end
  TestClient endless(port);
  endless.send("GET / HTTP/1.1\r\n");
  bool is_open = true;
  for (int i = 0; is_open && i < 100'000; ++i)
    is_open = endless.send("X: " + std::string(100, 'a') + "\r\n");
  EXPECT_FALSE(is_open);
  EXPECT_EQ(status_of(ask(port, "GET /")), 200);
}

TEST(Server, DropsAClientThatSendsTooSlowly) {
  const Server server(kAnyPort, "", test_routes());
  TestClient client(server.port());
  client.send("GET / HT");
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(client.receive(20.0), "");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(15));
}

TEST(Server, StreamsUntilTheClientGoes) {
  const Server server(kAnyPort, "", test_routes());
  {
    TestClient client(server.port());
    client.send(fmt::format("GET /events HTTP/1.1\r\nHost: localhost:{}\r\n\r\n", server.port()));
    EXPECT_NE(client.receive(8.0, "data: 3\n\n").find("data: 3\n\n"), std::string::npos);
    EXPECT_EQ(server.num_streams(), 1);
  }
  for (int i = 0; i < 100 && server.num_streams() > 0; ++i) rest(0.05);
  EXPECT_EQ(server.num_streams(), 0);
}

TEST(Server, DropsASlowReader) {
  const Server server(kAnyPort, "", test_routes(8'000'000));
  TestClient client(server.port(), true);
  client.send(fmt::format("GET /events HTTP/1.1\r\nHost: localhost:{}\r\n\r\n", server.port()));
  for (int i = 0; i < 100 && server.num_streams() == 0; ++i) rest(0.05);
  EXPECT_EQ(server.num_streams(), 1);
  // 8 MB may take 84 s; another client is served meanwhile
  EXPECT_EQ(status_of(ask(server.port(), "GET /")), 200);
}

TEST(Server, LimitsTheNumberOfStreams) {
  const Server server(kAnyPort, "", test_routes());
  const std::string request =
      fmt::format("GET /events HTTP/1.1\r\nHost: localhost:{}\r\n\r\n", server.port());
  std::vector<TestClient> clients;
  for (int i = 0; i < kMaxStreams; ++i) {
    clients.emplace_back(server.port());
    clients.back().send(request);
    EXPECT_EQ(status_of(clients.back().receive(8.0, "data: 0")), 200) << i;
  }
  EXPECT_EQ(status_of(ask(server.port(), "GET /events")), 503);
  EXPECT_EQ(status_of(ask(server.port(), "GET /")), 200);
}

TEST(Server, SurvivesAThousandConnections) {
  const Server server(kAnyPort, "", test_routes());
  std::vector<TestClient> clients;
  for (int i = 0; i < 1000; ++i) {
    clients.emplace_back(server.port());
    clients.back().send("GET / HTTP/1.1\r\n");
  }
  clients.clear();
  int status = 0;
  for (int i = 0; i < 100 && status != 200; ++i) {
    status = status_of(ask(server.port(), "GET /"));
    rest(0.05);
  }
  EXPECT_EQ(status, 200);
}

TEST(Server, SaysWhichPortIsTaken) {
  const Server first(kAnyPort, "", test_routes());
  const Place same{"127.0.0.1", first.port(), true};
  EXPECT_THROW(Server(same, "", test_routes()), core::InputError);
  const Server another(Place{"127.0.0.1", first.port()}, "", test_routes());
  EXPECT_NE(another.port(), first.port());
}

}  // namespace
}  // namespace samewhere::view
