#include <gtest/gtest.h>

#include <samewhere/view/request_head.hpp>

namespace samewhere::view {
namespace {

int status_for(const std::string& head) { return checked_head(head).status; }

TEST(RequestHead, KeepsThoseHeadersAloneThatAreRead) {
  const RequestHead head = checked_head(
      "GET /events?token=1 HTTP/1.1\r\nHOST: a:1\r\nRange: bytes=0-,0-,0-\r\nAccept-Encoding: "
      "gzip, br\r\n"
      "Cookie: x\r\nOrigin:  http://a:1 \r\n\r\n");
  EXPECT_EQ(head.status, 0);
  EXPECT_EQ(head.text, "GET /events?token=1 HTTP/1.1\r\nhost: a:1\r\norigin: http://a:1\r\n\r\n");
}

TEST(RequestHead, RefusesWhatIsAmbiguous) {
  EXPECT_EQ(status_for("GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n"), 400);
  EXPECT_EQ(status_for("GET / HTTP/1.1\r\nno colon\r\n\r\n"), 400);
  EXPECT_EQ(status_for("GET / HTTP/1.1\r\nHost: a\nb\r\n\r\n"), 400);
  EXPECT_EQ(status_for("GET / HTTP/1.0\r\n\r\n"), 400);
  EXPECT_EQ(status_for("GET http://a/ HTTP/1.1\r\n\r\n"), 501);
  EXPECT_EQ(status_for("PUT / HTTP/1.1\r\n\r\n"), 501);
  EXPECT_EQ(status_for("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n"), 501);
  EXPECT_EQ(status_for(std::string("GET /\0 HTTP/1.1\r\n\r\n", 19)), 400);
  EXPECT_EQ(status_for("GET / HTTP/1.1\r\nHost: a\r\n"), 400);
}

TEST(RequestHead, RefusesLargeBodies) {
  const auto with_length = [](const std::string& length) {
    return status_for("POST / HTTP/1.1\r\nContent-Length: " + length + "\r\n\r\n");
  };
  EXPECT_EQ(with_length("65536"), 0);
  EXPECT_EQ(with_length("65537"), 413);
  EXPECT_EQ(with_length("99999999999999999999999"), 413);
  EXPECT_EQ(with_length("-1"), 400);
  EXPECT_EQ(with_length("1 2"), 400);
}

}  // namespace
}  // namespace samewhere::view
