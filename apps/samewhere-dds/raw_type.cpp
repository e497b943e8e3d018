#include "raw_type.hpp"

#include <cstring>
#include <memory>
#include <utility>

#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

namespace samewhere::dds_node {
namespace {

// Samples of DDS are padded to this.
constexpr std::size_t kWord = 4;

struct RawSample : ddsi_serdata {
  std::string bytes;
};

const RawSample& as_raw(const ddsi_serdata* sample) {
  return *static_cast<const RawSample*>(sample);
}

RawSample* new_sample(const ddsi_sertype* type, ddsi_serdata_kind kind, std::string bytes) {
  auto sample = std::make_unique<RawSample>();
  ddsi_serdata_init(sample.get(), type, kind);
  sample->hash = type->serdata_basehash;
  bytes.append((kWord - bytes.size() % kWord) % kWord, '\0');
  sample->bytes = std::move(bytes);
  return sample.release();
}

// No keys: all samples are of one instance.
bool equal_keys(const ddsi_serdata* /*one*/, const ddsi_serdata* /*other*/) { return true; }

std::uint32_t size_of(const ddsi_serdata* sample) {
  return static_cast<std::uint32_t>(as_raw(sample).bytes.size());
}

// Fragments as the network brought them; they may overlap.
ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                             const nn_rdata* fragment, std::size_t size) {
  std::string bytes(size, '\0');
  std::uint32_t num_done = 0;
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    if (fragment->maxp1 <= num_done || fragment->maxp1 > size) continue;
    const unsigned char* payload =
        NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    std::memcpy(bytes.data() + num_done, payload + (num_done - fragment->min),
                fragment->maxp1 - num_done);
    num_done = fragment->maxp1;
  }
  return new_sample(type, kind, std::move(bytes));
}

ddsi_serdata* from_pieces(const ddsi_sertype* type, ddsi_serdata_kind kind,
                          ddsrt_msg_iovlen_t num_pieces, const ddsrt_iovec_t* pieces,
                          std::size_t size) {
  std::string bytes;
  bytes.reserve(size);
  for (ddsrt_msg_iovlen_t i = 0; i < num_pieces; ++i)
    bytes.append(static_cast<const char*>(pieces[i].iov_base), pieces[i].iov_len);
  bytes.resize(size);
  return new_sample(type, kind, std::move(bytes));
}

ddsi_serdata* from_key(const ddsi_sertype* type, const ddsi_keyhash* /*key*/) {
  return new_sample(type, SDK_KEY, {});
}

ddsi_serdata* from_string(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* sample) {
  return new_sample(type, kind,
                    kind == SDK_DATA ? *static_cast<const std::string*>(sample) : std::string());
}

void copy_bytes(const ddsi_serdata* sample, std::size_t offset, std::size_t size, void* out) {
  std::memcpy(out, as_raw(sample).bytes.data() + offset, size);
}

ddsi_serdata* lend_bytes(const ddsi_serdata* sample, std::size_t offset, std::size_t size,
                         ddsrt_iovec_t* piece) {
  // an iovec has no const, and is read alone
  piece->iov_base = const_cast<char*>(as_raw(sample).bytes.data()) + offset;
  piece->iov_len = size;
  return ddsi_serdata_ref(sample);
}

void give_bytes_back(ddsi_serdata* sample, const ddsrt_iovec_t* /*piece*/) {
  ddsi_serdata_unref(sample);
}

// dds_take() is not used, dds_takecdr() is.
bool to_string(const ddsi_serdata* sample, void* out, void** /*buffer*/, void* /*end*/) {
  *static_cast<std::string*>(out) = as_raw(sample).bytes;
  return true;
}

ddsi_serdata* to_untyped(const ddsi_serdata* sample) {
  RawSample* key = new_sample(sample->type, SDK_KEY, {});
  key->type = nullptr;
  return key;
}

bool untyped_to_string(const ddsi_sertype* /*type*/, const ddsi_serdata* /*sample*/, void* /*out*/,
                       void** /*buffer*/, void* /*end*/) {
  return true;
}

void free_sample(ddsi_serdata* sample) { delete static_cast<RawSample*>(sample); }

std::size_t print_sample(const ddsi_sertype* /*type*/, const ddsi_serdata* /*sample*/, char* text,
                         std::size_t size) {
  if (size > 0) text[0] = '\0';
  return 0;
}

void key_of(const ddsi_serdata* /*sample*/, ddsi_keyhash* key, bool /*force_md5*/) {
  std::memset(key, 0, sizeof(*key));
}

const ddsi_serdata_ops& sample_functions() {
  static const ddsi_serdata_ops functions = [] {
    ddsi_serdata_ops ops{};
    ops.eqkey = equal_keys;
    ops.get_size = size_of;
    ops.from_ser = from_fragments;
    ops.from_ser_iov = from_pieces;
    ops.from_keyhash = from_key;
    ops.from_sample = from_string;
    ops.to_ser = copy_bytes;
    ops.to_ser_ref = lend_bytes;
    ops.to_ser_unref = give_bytes_back;
    ops.to_sample = to_string;
    ops.to_untyped = to_untyped;
    ops.untyped_to_sample = untyped_to_string;
    ops.free = free_sample;
    ops.print = print_sample;
    ops.get_keyhash = key_of;
    return ops;
  }();
  return functions;
}

void free_type(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete type;
}

void zero_strings(const ddsi_sertype* /*type*/, void* /*samples*/, std::size_t /*count*/) {}

// Samples of the application are strings of its own; none is made here.
void grow_strings(void** /*samples*/, const ddsi_sertype* /*type*/, void* /*old*/,
                  std::size_t /*old_count*/, std::size_t /*count*/) {}

void free_strings(const ddsi_sertype* /*type*/, void** /*samples*/, std::size_t /*count*/,
                  dds_free_op_t /*operation*/) {}

bool equal_types(const ddsi_sertype* /*one*/, const ddsi_sertype* /*other*/) {
  return true;  // their names are
}

std::uint32_t hash_type(const ddsi_sertype* /*type*/) { return 0; }

std::size_t serialized_size(const ddsi_sertype* /*type*/, const void* sample) {
  return static_cast<const std::string*>(sample)->size();
}

bool serialize_into(const ddsi_sertype* /*type*/, const void* sample, void* out, std::size_t size) {
  const auto& bytes = *static_cast<const std::string*>(sample);
  if (size < bytes.size()) return false;
  std::memcpy(out, bytes.data(), bytes.size());
  return true;
}

const ddsi_sertype_ops& type_functions() {
  static const ddsi_sertype_ops functions = [] {
    ddsi_sertype_ops ops{};
    ops.version = ddsi_sertype_v0;
    ops.free = free_type;
    ops.zero_samples = zero_strings;
    ops.realloc_samples = grow_strings;
    ops.free_samples = free_strings;
    ops.equal = equal_types;
    ops.hash = hash_type;
    ops.get_serialized_size = serialized_size;
    ops.serialize_into = serialize_into;
    return ops;
  }();
  return functions;
}

}  // namespace

dds_entity_t create_raw_topic(dds_entity_t participant, const std::string& name,
                              const std::string& type_name) {
  auto type = std::make_unique<ddsi_sertype>();
  std::memset(type.get(), 0, sizeof(*type));
  constexpr bool kHasNoKey = true;
  ddsi_sertype_init(type.get(), type_name.c_str(), &type_functions(), &sample_functions(),
                    kHasNoKey);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  ddsi_sertype* given = type.release();
  const dds_entity_t topic =
      dds_create_topic_sertype(participant, name.c_str(), &given, nullptr, nullptr, nullptr);
  if (topic < 0) ddsi_sertype_unref(given);
  return topic;
}

std::string_view bytes_of(const ddsi_serdata* sample) { return as_raw(sample).bytes; }

void release(ddsi_serdata* sample) { ddsi_serdata_unref(sample); }

}  // namespace samewhere::dds_node
