#include <samewhere/core/similarity.hpp>
#include <samewhere/verify/decide.hpp>
#include <samewhere/verify/sequence_verifier.hpp>

namespace samewhere::verify {

SequenceVerifier::SequenceVerifier(const MeasureSettings& settings, std::uint64_t window_frames)
    : config_(settings.verify),
      window_frames_(window_frames),
      numbered_(settings.features, settings.verify.same_view_ratio),
      pending_(settings.verify) {}

void SequenceVerifier::add(const features::View& view, const core::Descriptor& descriptor) {
  if (needs_sequences(config_)) numbered_.add(view, descriptor);
}

void SequenceVerifier::number(const core::Candidate& candidate, core::Evidence& evidence) const {
  if (!evidence.geometry || !needs_sequences(config_)) return;
  evidence.sequence = {.query_view = numbered_.number_of(candidate.query),
                       .match_view = numbered_.number_of(candidate.match)};
}

void SequenceVerifier::record(const core::LedgerRow& row) {
  if (!needs_sequences(config_)) return;
  recorded_.insert({row.candidate.query, row.candidate.match});
  if (is_pending(row.verdict)) pending_.add(row.candidate, core::evidence_of(row.verdict));
}

std::vector<core::Candidate> SequenceVerifier::predict(const core::Descriptor& descriptor) {
  std::vector<core::Candidate> candidates;
  if (!needs_sequences(config_)) return candidates;
  const int now = numbered_.number_of(descriptor.frame);
  for (const ViewPair& views : pending_.predict(now)) {
    const auto* match = numbered_.at(views.match);
    const auto* query = views.query == now ? &descriptor : numbered_.at(views.query);
    if (query == nullptr || match == nullptr) continue;
    const bool is_recent = query->frame.index() <= match->frame.index() + window_frames_;
    if (is_recent || recorded_.contains({query->frame, match->frame})) continue;
    candidates.push_back({.query = query->frame,
                          .match = match->frame,
                          .similarity = core::ncc(query->unit, match->unit),
                          .origin = core::Origin::kPredicted});
  }
  return candidates;
}

std::vector<core::LedgerRow> SequenceVerifier::settle(core::FrameId frame) {
  if (!needs_sequences(config_)) return {};
  return pending_.settle(numbered_.number_of(frame));
}

}  // namespace samewhere::verify
