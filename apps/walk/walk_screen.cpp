#include "apps/walk/walk_screen.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <functional>
#include <limits>
#include <string_view>

#include "core/math/xyz.h"
#include "io/net/walk_frame.h"
#include "io/picture/difference_colour.h"

namespace lightwalk {
namespace {

constexpr int kPieceWidth = 160, kPieceHeight = 120;  // [pixels]
constexpr int kHurriedQuality = 75, kMovingQuality = 85, kProgressiveQuality = 95;
/// A frame of a view in motion should take no longer on the wire [s].
constexpr double kLongestWay = 0.05;
constexpr double kBytesAPixel = 0.45;  ///< of such a frame, depth included
/// Where a link is slower frames are smaller, too, so that each takes so long [s].
constexpr double kLongestSmallWay = 0.2;
constexpr std::size_t kLookedAt = 19;  // every so-manieth pixel tells how bright a picture is

}  // namespace

WalkScreen::WalkScreen(Executor& executor)
    : executor_(executor), compressors_(static_cast<std::size_t>(executor.concurrency())) {}

void WalkScreen::update_clients(const InboxContents& news) {
    for (const ClientId client : news.joined) clients_.try_emplace(client);
    for (const ClientId client : news.want_depth) clients_[client].wants_depth = true;
    for (const ClientId client : news.want_luminance) clients_[client].wants_luminance = true;
    for (const ClientId client : news.left) clients_.erase(client);
    acked(news.acks);
}

void WalkScreen::acked(std::span<const WalkAck> acks) {
    for (const WalkAck& ack : acks) {
        const auto found = clients_.find(ack.client);
        if (found != clients_.end()) (void)found->second.flow.acked(ack.frame, ack.came);
    }
}

void WalkScreen::cut(int width, int height) {
    width_ = width;
    height_ = height;
    bytes_.assign(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
    pieces_.clear();
    for (int y = 0; y < height; y += kPieceHeight)
        for (int x = 0; x < width; x += kPieceWidth)
            pieces_.push_back(
                {{x, y, std::min(x + kPieceWidth, width), std::min(y + kPieceHeight, height)}});
    contents_.assign(pieces_.size() + 2, 0);
    luminance_.begin(width, height);
}

std::size_t WalkScreen::how_many(bool Client::*want) const {
    return static_cast<std::size_t>(
        std::count_if(clients_.begin(), clients_.end(),
                      [want](const auto& client) { return client.second.*want; }));
}

std::vector<std::size_t> WalkScreen::missing(const Client& client) const {
    std::vector<std::size_t> pieces = client.flow.missing(layout(), contents_);
    const auto unwanted = [&](std::size_t i) {
        return (i == depth_index() && !client.wants_depth) ||
               (i == luminance_index() && !client.wants_luminance);
    };
    pieces.erase(std::remove_if(pieces.begin(), pieces.end(), unwanted), pieces.end());
    return pieces;
}

void WalkScreen::measure_depth(const LivePicture& picture, const View& view, double eye_height) {
    // Not kept for who comes later: it would be that of an earlier picture.
    if (how_many(&Client::wants_depth) > 0)
        depth_.keep(picture, view, eye_height, executor_);
    else
        depth_.forget();
}

void WalkScreen::adapt(const LivePicture& picture, Time now) {
    ++pictures_;
    if (lead_ != nullptr && lead_->brightness_) {
        followed_ = lead_->pictures_;
        eye_ = lead_->eye_;
        brightness_ = lead_->brightness_;
    } else {
        brightness_.emplace(picture.radiance, kLookedAt);
        eye_.look_at(*brightness_, std::chrono::duration<double>(now - last_look_).count());
    }
    last_look_ = now;
}

void WalkScreen::show(const LivePicture& picture, const DisplayRequest& request,
                      const ShownView& view, Time now, std::span<const Rgb> clean) {
    assert(clean.empty() || clean.size() == picture.radiance.size());
    if (picture.width != width_ || picture.height != height_) cut(picture.width, picture.height);
    adapt(picture, now);
    const Display display(request.settings, eye_, *brightness_);
    exposure_ = static_cast<float>(display.exposure());
    display_ = request.number;
    view_ = view;
    view_.denoised = !clean.empty() && difference_ == nullptr;
    const std::span<const Rgb> radiance = clean.empty() ? std::span(picture.radiance) : clean;
    contents_[depth_index()] = depth_.content();
    const bool measured = how_many(&Client::wants_luminance) > 0;
    const int quality = view.at_rest ? kProgressiveQuality : moving_quality();
    executor_.for_each(pieces_.size(), [&](std::size_t i, int) {
        colour(pieces_[i], picture, radiance, display, quality);
        contents_[i] = pieces_[i].content;
        if (measured) luminance_.measure(picture.radiance, pieces_[i].area);
    });
    if (measured)
        luminance_.finish(difference_ != nullptr ? 0 : static_cast<float>(display.white()));
    else
        luminance_.forget();  // for who comes later it would be that of an earlier picture
    contents_[luminance_index()] = luminance_.content();
}

/// Quality of frames of a view in motion: less where a link would take long to carry them, as far
/// as is known of it.
int WalkScreen::moving_quality() const {
    const double bytes = kBytesAPixel * width_ * height_;
    const bool slow = std::any_of(clients_.begin(), clients_.end(), [bytes](const auto& client) {
        const double speed = client.second.flow.bytes_per_second();
        return speed > 0 && bytes > kLongestWay * speed;
    });
    return slow ? kHurriedQuality : kMovingQuality;
}

double WalkScreen::most_moving_pixels() const {
    double most = std::numeric_limits<double>::max();
    for (const auto& [id, client] : clients_) {
        const double speed = client.flow.bytes_per_second();
        if (speed > 0) most = std::min(most, kLongestSmallWay * speed / kBytesAPixel);
    }
    return most;
}

/// One row of an area. Pictures of views in motion may be of different sizes.
void WalkScreen::show_difference(const LivePicture& base, const LivePicture& picture,
                                 const PixelRectangle& area, int y, std::span<std::uint8_t> row) {
    const auto place = [](int at, int side, int other_side) {
        constexpr std::int64_t kTwice = 2;
        return static_cast<std::size_t>((kTwice * at + 1) * other_side / (kTwice * side));
    };
    const std::size_t below = place(y, picture.height, base.height);
    const Rgb* const before = &base.radiance[below * static_cast<std::size_t>(base.width)];
    const Rgb* const now =
        &picture.radiance[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width)];
    for (int x = area.x0; x < area.x1; ++x) {
        const std::array<std::uint8_t, 3> colour = difference_colour(
            brightness(before[place(x, picture.width, base.width)]), brightness(now[x]));
        std::ranges::copy(colour, &row[3 * static_cast<std::size_t>(x - area.x0)]);
    }
}

/// A piece that shows the same as before need not be compressed, nor sent, again.
void WalkScreen::colour(Piece& piece, const LivePicture& picture, std::span<const Rgb> radiance,
                        const Display& display, int quality) {
    const PixelRectangle& area = piece.area;
    const auto width = static_cast<std::size_t>(area.width());
    std::size_t content = static_cast<std::size_t>(quality);
    for (int y = area.y0; y < area.y1; ++y) {
        const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                  static_cast<std::size_t>(area.x0);
        const std::span<std::uint8_t> row = std::span(bytes_).subspan(3 * first, 3 * width);
        if (difference_ != nullptr)
            show_difference(*difference_, picture, area, y, row);
        else
            display.show(radiance.subspan(first, width), row);
        const std::string_view text(reinterpret_cast<const char*>(row.data()), row.size());
        content = content * 0x9E3779B97F4A7C15U + std::hash<std::string_view>{}(text);
    }
    if (piece.content == content) return;
    piece.content = content;
    piece.quality = quality;
    piece.compressed = false;
}

void WalkScreen::compress(std::span<const std::size_t> pieces) {
    executor_.for_each(pieces.size(), [&](std::size_t i, int worker) {
        if (pieces[i] >= pieces_.size()) return;  // depth and luminance are by themselves
        Piece& piece = pieces_[pieces[i]];
        if (piece.compressed) return;
        const auto stride = 3 * static_cast<std::size_t>(width_);
        const std::uint8_t* first = bytes_.data() +
                                    static_cast<std::size_t>(piece.area.y0) * stride +
                                    3 * static_cast<std::size_t>(piece.area.x0);
        const std::span<const std::uint8_t> jpeg =
            compressors_[static_cast<std::size_t>(worker)].compress(
                {first, piece.area.width(), piece.area.height(), stride}, piece.quality);
        piece.bytes.assign(reinterpret_cast<const char*>(jpeg.data()), jpeg.size());
        piece.compressed = true;
    });
}

WalkScreen::Time WalkScreen::next_chance() const {
    Time soonest = Time::max();
    for (const auto& [id, client] : clients_)
        if (lacks(client)) soonest = std::min(soonest, client.flow.next_chance());
    return soonest;
}

std::shared_ptr<const std::string> WalkScreen::frame_of(std::span<const std::size_t> pieces,
                                                        bool whole) {
    WalkFrameHeader header;
    header.frame = frame_;
    header.view = view_.id;
    header.width = static_cast<std::uint16_t>(width_);
    header.height = static_cast<std::uint16_t>(height_);
    header.whole = whole;
    header.at_rest = view_.at_rest;
    header.finished = view_.finished;
    header.denoised = view_.denoised;
    header.display = display_;
    header.exposure = exposure_;
    header.eye = view_.eye;
    std::vector<WalkFramePiece> sent;
    for (const std::size_t i : pieces) {
        if (i >= pieces_.size()) {
            const bool depth = i == depth_index();
            sent.push_back(
                {0, 0, header.width, header.height,
                 depth ? PieceCodec::depth : PieceCodec::luminance,
                 depth ? depth_.bytes(executor_) : luminance_.bytes(compressors_.front())});
            continue;
        }
        const Piece& piece = pieces_[i];
        sent.push_back(
            {static_cast<std::uint16_t>(piece.area.x0), static_cast<std::uint16_t>(piece.area.y0),
             static_cast<std::uint16_t>(piece.area.width()),
             static_cast<std::uint16_t>(piece.area.height()), PieceCodec::jpeg, piece.bytes});
    }
    return std::make_shared<const std::string>(encode_walk_frame(header, sent));
}

void WalkScreen::send(ClientInbox& client_inbox, Time now) {
    if (pieces_.empty()) return;
    ++frame_;
    std::map<std::pair<bool, std::vector<std::size_t>>, std::shared_ptr<const std::string>> made;
    for (auto& [id, client] : clients_) {
        if (!client.flow.may_send(now) || !lacks(client)) continue;
        const std::vector<std::size_t> pieces = missing(client);
        const bool whole = pieces.size() == wanted(client);
        std::shared_ptr<const std::string>& frame = made[{whole, pieces}];
        if (!frame) {
            compress(pieces);
            frame = frame_of(pieces, whole);
        }
        client_inbox.send(id, frame);
        client.flow.sent(frame_, layout(), contents_, frame->size(), now);
        client.shown = view_;
    }
}

}  // namespace lightwalk
