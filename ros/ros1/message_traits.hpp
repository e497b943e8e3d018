#pragma once

#include <cstring>
#include <string>
#include <type_traits>

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/service_traits.h>

#include <samewhere/messages/types.hpp>

// The structs of samewhere::messages as messages of ROS 1: roscpp gives their bytes to our reader
// and takes them from our writer.

namespace samewhere::ros1 {

template <class M>
concept Message = requires {
  M::kType;
};

// roscpp keeps pointers to these for the life of the program.
template <Message M>
struct TypeTexts {
  static const TypeTexts& get() {
    static const TypeTexts texts;
    return texts;
  }
  std::string md5{messages::type_of<M>().md5};
  std::string name = messages::type_of<M>().ros1_name();
  std::string definition =
      messages::full_definition(messages::type_of<M>(), messages::Layout::kRos1);
};

// Requests and responses of std_srvs, whose own headers need a standard before C++20.
struct Trigger {
  static constexpr const char* kName = "std_srvs/Trigger";
  static constexpr const char* kMd5 = "937c9679a518e3a18d831e57125ea522";
};
struct SetBool {
  static constexpr const char* kName = "std_srvs/SetBool";
  static constexpr const char* kMd5 = "09fb03525b03e7ea1fd3992bafd87e16";
};

template <class Of>
struct ServiceRequest {
  using Service = Of;
  bool data = false;  // of SetBool alone
};
template <class Wire, class Of>
void fields(Wire& wire, ServiceRequest<Of>& m) {
  if constexpr (std::is_same_v<Of, SetBool>) wire(m.data);
}

template <class Of>
struct ServiceResponse {
  using Service = Of;
  bool success = false;
  std::string message;
};
template <class Wire, class Of>
void fields(Wire& wire, ServiceResponse<Of>& m) {
  wire(m.success, m.message);
}

template <class M>
concept PartOfService = requires {
  M::Service::kMd5;
};

}  // namespace samewhere::ros1

namespace ros::message_traits {

template <samewhere::ros1::Message M>
struct IsMessage<M> : TrueType {};
template <samewhere::ros1::Message M>
struct IsMessage<const M> : TrueType {};

template <samewhere::ros1::Message M>
struct MD5Sum<M> {
  static const char* value() { return samewhere::ros1::TypeTexts<M>::get().md5.c_str(); }
  static const char* value(const M& /*message*/) { return value(); }
};

template <samewhere::ros1::Message M>
struct DataType<M> {
  static const char* value() { return samewhere::ros1::TypeTexts<M>::get().name.c_str(); }
  static const char* value(const M& /*message*/) { return value(); }
};

template <samewhere::ros1::Message M>
struct Definition<M> {
  static const char* value() { return samewhere::ros1::TypeTexts<M>::get().definition.c_str(); }
  static const char* value(const M& /*message*/) { return value(); }
};

template <samewhere::ros1::PartOfService M>
struct DataType<M> {
  static const char* value() { return M::Service::kName; }
  static const char* value(const M& /*part*/) { return value(); }
};

}  // namespace ros::message_traits

namespace ros::service_traits {

template <samewhere::ros1::PartOfService M>
struct MD5Sum<M> {
  static const char* value() { return M::Service::kMd5; }
  static const char* value(const M& /*part*/) { return value(); }
};

template <samewhere::ros1::PartOfService M>
struct DataType<M> {
  static const char* value() { return M::Service::kName; }
  static const char* value(const M& /*part*/) { return value(); }
};

}  // namespace ros::service_traits

namespace ros::serialization {

template <class M>
requires samewhere::ros1::Message<M> || samewhere::ros1::PartOfService<M>
struct Serializer<M> {
  template <class Stream>
  static void write(Stream& stream, const M& message) {
    const std::string bytes =
        samewhere::messages::write_message(message, samewhere::messages::Layout::kRos1);
    std::memcpy(stream.advance(static_cast<std::uint32_t>(bytes.size())), bytes.data(),
                bytes.size());
  }
  template <class Stream>
  static void read(Stream& stream, M& message) {
    const std::uint32_t length = stream.getLength();
    const std::string_view bytes(reinterpret_cast<const char*>(stream.advance(length)), length);
    message = samewhere::messages::read_message<M>(bytes, samewhere::messages::Layout::kRos1);
  }
  static std::uint32_t serializedLength(const M& message) {
    return static_cast<std::uint32_t>(
        samewhere::messages::write_message(message, samewhere::messages::Layout::kRos1).size());
  }
};

}  // namespace ros::serialization
