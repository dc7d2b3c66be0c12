#include "apps/head/newest_frame.h"

#include <algorithm>
#include <variant>

#include "core/error.h"
#include "io/net/walk_reply.h"

namespace lightwalk {
namespace {

constexpr std::size_t kLongestSaid = 4096;                           // of what is said [bytes]
constexpr std::size_t kMostViews = 64;                               // on their way to a frame
constexpr std::size_t kLargestKept = std::size_t{64} * 1024 * 1024;  // [bytes]

}  // namespace

void NewestFrame::said(std::string_view text) {
    if (text.size() > kLongestSaid) return;
    try {
        const WalkRequest request = parse_walk_request(text);
        if (const auto* const display = std::get_if<DisplayRequest>(&request)) display_ = *display;
        const auto* const view = std::get_if<ViewRequest>(&request);
        if (view == nullptr) return;
        views_.push_back(*view);
        if (views_.size() > kMostViews) views_.pop_front();
    } catch (const InputError&) {  // which the run tells
    }
}

NewestFrame::Place NewestFrame::place_of(const WalkFramePiece& piece) {
    return {piece.codec, piece.x, piece.y, piece.width, piece.height};
}

void NewestFrame::came(ClientId client, bool drives, std::string_view message) {
    const std::optional<WalkFrameParts> frame = parse_walk_frame(message);
    if (!frame) return;
    const bool begins = frame->header.whole && (!followed_ || drives);
    if (followed_ != client && !begins) return;
    if (frame->header.whole) pieces_.clear();
    // It would mix pictures otherwise.
    const bool fits = frame->header.whole ||
                      std::ranges::all_of(frame->pieces, [this](const WalkFramePiece& piece) {
                          return pieces_.contains(place_of(piece));
                      });
    if (!fits || message.size() > kLargestKept) {
        pieces_.clear();
        followed_.reset();
        return;
    }
    followed_ = client;
    for (const WalkFramePiece& piece : frame->pieces) pieces_[place_of(piece)] = piece.bytes;
    header_ = frame->header;
    note_view(header_.view);
}

void NewestFrame::note_view(std::uint32_t id) {
    if (view_ && view_->id == id && views_.empty()) return;
    const auto found = std::ranges::find(views_.rbegin(), views_.rend(), id, &ViewRequest::id);
    if (found != views_.rend()) {
        view_ = *found;
        views_.erase(views_.begin(), found.base());
    } else if (view_ && view_->id != id) {
        view_.reset();
    }
}

void NewestFrame::left(ClientId client) {
    if (followed_ == client) followed_.reset();
}

std::optional<NewestFrame::Messages> NewestFrame::messages(const HelloRequest& to) const {
    if (pieces_.empty()) return std::nullopt;
    Messages told;
    if (display_) told.texts.push_back(walk_text(DisplayReply{*display_}));
    if (view_) {
        ViewReply seen{view_->view, view_->seen};
        seen.view.position = header_.eye;
        told.texts.push_back(walk_text(seen));
    }
    std::vector<WalkFramePiece> wanted;
    for (const auto& [place, bytes] : pieces_) {
        const auto& [codec, x, y, width, height] = place;
        if ((codec == PieceCodec::depth && !to.depth) ||
            (codec == PieceCodec::luminance && !to.luminance))
            continue;
        wanted.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                          static_cast<std::uint16_t>(width), static_cast<std::uint16_t>(height),
                          codec, bytes});
    }
    WalkFrameHeader header = header_;
    header.whole = true;
    told.frame = encode_walk_frame(header, wanted);
    return told;
}

}  // namespace lightwalk
