#pragma once
// Clients of a walk that write down what they are sent.
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "apps/walk/client_inbox.h"

namespace lightwalk::test {

class RecordedClients final : public WebSender {
  public:
    void send_text(ClientId client, std::string text) override {
        texts[client].push_back(std::move(text));
    }
    void send_binary(ClientId client, std::shared_ptr<const std::string> bytes) override {
        frames[client].push_back(std::move(bytes));
    }
    void close(ClientId client, std::string reason) override { closed[client] = std::move(reason); }
    /// Whether a client was sent a message of a type, or one that holds `words` as well.
    [[nodiscard]] bool got(ClientId client, const std::string& type,
                           std::string_view words = {}) const {
        const auto found = texts.find(client);
        if (found == texts.end()) return false;
        for (const std::string& text : found->second)
            if (text.find("\"type\":\"" + type + "\"") != std::string::npos &&
                text.find(words) != std::string::npos)
                return true;
        return false;
    }
    [[nodiscard]] std::size_t frames_of(ClientId client) const {
        const auto found = frames.find(client);
        return found == frames.end() ? 0 : found->second.size();
    }

    std::map<ClientId, std::vector<std::string>> texts;
    std::map<ClientId, std::string> closed;  ///< why
    std::map<ClientId, std::vector<std::shared_ptr<const std::string>>> frames;
};

/// The number at a place of a frame's header, see io/net/README.md.
template <class Number>
[[nodiscard]] Number number_at(const std::string& frame, std::size_t offset) {
    Number number{};
    std::memcpy(&number, frame.data() + offset, sizeof number);
    return number;
}
[[nodiscard]] inline std::uint32_t frame_number(const std::string& frame) {
    return number_at<std::uint32_t>(frame, 4);
}
[[nodiscard]] inline int frame_flags(const std::string& frame) {
    return number_at<std::uint8_t>(frame, 16);
}
[[nodiscard]] inline int frame_pieces(const std::string& frame) {
    return number_at<std::uint16_t>(frame, 18);
}

/// Messages of a page.
[[nodiscard]] inline std::string hello(const std::string& session = "0123456789abcdef") {
    return R"({"type":"hello","session":")" + session + "\"}";
}
[[nodiscard]] inline std::string view_message(int id, double x, int width = 32, int height = 24) {
    return R"({"type":"view","id":)" + std::to_string(id) + R"(,"view":{"type":"v","position":[)" +
           std::to_string(x) +
           R"(,-4,1.5],"direction":[0,1,-0.05],"up":[0,0,1],"horizontal":60,"vertical":46.8},)" +
           R"("width":)" + std::to_string(width) + R"(,"height":)" + std::to_string(height) +
           R"(,"moving":false,"walk":false})";
}

}  // namespace lightwalk::test
