#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <samewhere/messages/types.hpp>
#include <samewhere/node/topics.hpp>

namespace samewhere::dds_node {

// A participant in a ROS 2 graph: topics have the names, types and qualities of service that ROS 2
// gives them. What it publishes itself it does not receive.
class Graph {
 public:
  using Receive = std::function<void(std::string_view cdr)>;

  // Throws core::InputError if the domain cannot be joined.
  explicit Graph(int domain);
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;
  ~Graph();

  // `name` as ROS 2 has it: /camera/image_raw. `receive` is called by spin().
  void subscribe(const std::string& name, const messages::MessageType& type,
                 const node::Quality& quality, Receive receive);
  // Returns its number.
  int advertise(const std::string& name, const messages::MessageType& type,
                const node::Quality& quality);
  // From any thread.
  void publish(int writer, const std::string& cdr) const;

  // Waits so long for messages and gives them out in the order of the subscriptions. Bytes that are
  // no message of their type are left out, with one warning per topic.
  void spin(double seconds);

 private:
  struct Reader {
    int entity = 0;
    std::string name;
    Receive receive;
    bool has_warned = false;
  };
  void take_from(Reader& reader);
  int topic(const std::string& name, const messages::MessageType& type) const;

  int participant_ = 0;
  int waitset_ = 0;
  std::vector<Reader> readers_;
  std::vector<int> writers_;
};

}  // namespace samewhere::dds_node
