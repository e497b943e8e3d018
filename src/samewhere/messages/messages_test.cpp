#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/messages/idl.hpp>
#include <samewhere/messages/types.hpp>

namespace samewhere::messages {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string hex(std::string_view bytes) {
  std::string text;
  for (const char byte : bytes) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    const auto value = static_cast<unsigned char>(byte);
    text.push_back(kDigits[value / 16]);
    text.push_back(kDigits[value % 16]);
  }
  return text;
}

CompressedImage small_picture() {
  return {.header = {.stamp = {.sec = 1, .nanosec = 2}, .frame_id = "ab"},
          .format = "png",
          .data = {7, 8}};
}

TEST(Wire, LaysFieldsOutAsCdrDoes) {
  // byte order; sec, nanosec; length with the zero byte, "ab", zero, padding; "png"; two bytes
  EXPECT_EQ(hex(write_message(small_picture(), Layout::kCdr)),
            "00010000"
            "0100000002000000"
            "03000000616200"
            "00"
            "04000000706e6700"
            "020000000708");
}

TEST(Wire, LaysFieldsOutAsRos1Does) {
  EXPECT_EQ(hex(write_message(small_picture(), Layout::kRos1)),
            "00000000"
            "0100000002000000"
            "020000006162"
            "03000000706e67"
            "020000000708");
}

TEST(Wire, AlignsNumbersOfEightBytesFromTheEndOfTheByteOrder) {
  const PoseStamped pose{.header = {.stamp = {}, .frame_id = "map"}};
  // 8 bytes of time, 8 of the name: the first number begins at 16 of the body
  EXPECT_EQ(write_message(pose, Layout::kCdr).size(), 4U + 16U + 56U);
  const PoseStamped longer{.header = {.stamp = {}, .frame_id = "map1"}};
  EXPECT_EQ(write_message(longer, Layout::kCdr).size(), 4U + 24U + 56U);
  EXPECT_EQ(write_message(longer, Layout::kRos1).size(), 4U + 8U + 8U + 56U);
}

CameraInfo some_camera() {
  CameraInfo info;
  info.header.frame_id = "camera";
  info.width = 640;
  info.distortion_model = "plumb_bob";
  info.d = {0.1, -0.2, 0.0, 0.0, 0.5};
  info.k = {500, 0, 320, 0, 501, 240, 0, 0, 1};
  info.roi.do_rectify = true;
  return info;
}

TEST(Wire, ReadsWhatItWrites) {
  for (const Layout layout : {Layout::kCdr, Layout::kRos1}) {
    const auto back = read_message<CameraInfo>(write_message(some_camera(), layout), layout);
    EXPECT_EQ(back.header.frame_id, "camera");
    EXPECT_EQ(back.width, 640U);
    EXPECT_THAT(back.d, ElementsAre(0.1, -0.2, 0.0, 0.0, 0.5));
    EXPECT_EQ(back.k, some_camera().k);
    EXPECT_TRUE(back.roi.do_rectify);
  }
}

TEST(Wire, ReadsTheOtherByteOrder) {
  const std::string bytes("\0\0\0\0\0\0\0\3ab\0", 11);
  EXPECT_EQ(read_message<String>(bytes, Layout::kCdr).data, "ab");
}

TEST(Wire, EveryCutMessageIsRefused) {
  for (const Layout layout : {Layout::kCdr, Layout::kRos1}) {
    const std::string whole = write_message(some_camera(), layout);
    for (std::size_t size = 0; size < whole.size(); ++size)
      EXPECT_THROW(read_message<CameraInfo>(whole.substr(0, size), layout), core::InputError);
  }
}

TEST(Wire, LengthsThatCannotBeTakeNoMemory) {
  const std::string bytes("\0\1\0\0\xff\xff\xff\xff", 8);
  EXPECT_THROW(read_message<String>(bytes, Layout::kCdr), core::InputError);
  EXPECT_THROW(read_message<TFMessage>(bytes, Layout::kCdr), core::InputError);
}

TEST(Time, CountsNanosecondsFromTheSecondBefore) {
  EXPECT_EQ(time_of(-0.25), (Time{-1, 750'000'000}));
  EXPECT_EQ(seconds(time_of(1305031102.175304)), 1305031102.175304);
  EXPECT_EQ(nanoseconds(time_of(1e300)), nanoseconds(Time{2147483647, 0}));
}

TEST(MessageTypes, AreFoundByEachOfTheirNames) {
  for (const char* name :
       {"sensor_msgs/Image", "sensor_msgs/msg/Image", "sensor_msgs::msg::dds_::Image_"}) {
    ASSERT_NE(find_message_type(name), nullptr) << name;
    EXPECT_EQ(find_message_type(name)->ros2_name(), "sensor_msgs/msg/Image");
  }
  EXPECT_EQ(find_message_type("tf/tfMessage")->name, "TFMessage");
  EXPECT_EQ(find_message_type("Image"), nullptr);
  EXPECT_EQ(find_message_type(""), nullptr);
}

TEST(MessageTypes, HaveDefinitionsWithAllTheirParts) {
  for (const MessageType& type : message_types()) {
    const std::string definition = full_definition(type, Layout::kCdr);
    EXPECT_TRUE(definition.starts_with(type.fields));
  }
  EXPECT_THAT(full_definition(type_of<CameraInfo>(), Layout::kRos1),
              HasSubstr("float64[9] K\nfloat64[9] R\nfloat64[12] P\n"));
  EXPECT_THAT(full_definition(type_of<Image>(), Layout::kRos1),
              HasSubstr("MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"));
}

TEST(Idl, HasTheNamesOfRos2InDds) {
  const std::string idl = idl_of(message_types());
  EXPECT_THAT(idl, HasSubstr("module sensor_msgs { module msg { module dds_ {\n"
                             "  struct CompressedImage_ {\n"
                             "    std_msgs::msg::dds_::Header_ header_;\n"
                             "    string format_;\n"
                             "    sequence<octet> data_;\n"
                             "  };\n}; }; };\n"));
  EXPECT_THAT(idl, HasSubstr("    double k_[9];\n"));
  EXPECT_THAT(idl, HasSubstr("sequence<geometry_msgs::msg::dds_::TransformStamped_> transforms_;"));
}

}  // namespace
}  // namespace samewhere::messages
