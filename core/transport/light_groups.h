#pragma once
// Light by groups of emitters: as radiance is a sum over emitters, so is what each group of them
// brings, and any mixture of dimmed groups is a weighted sum.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/transport/contribution.h"

namespace lightwalk {

inline constexpr std::size_t kMostLightGroups = 64;
/// The name of the group for all that belongs to no other, the constant -av among it.
inline constexpr const char* kRestGroup = "rest";

/// Sets of modifiers that emit light; each belongs to one.
struct LightGroups {
    std::vector<std::string> names;
    std::vector<std::uint8_t> of_modifier;  ///< group, by modifier
    std::uint8_t of_constant = 0;           ///< group of constant light
    [[nodiscard]] std::size_t size() const { return names.size(); }
    [[nodiscard]] std::size_t group_of(ModifierId modifier) const {
        return modifier == kVoid ? of_constant
                                 : of_modifier[static_cast<std::size_t>(index(modifier))];
    }
};

/// How much of each group's light is shown: dimmers.
struct LightMixture {
    std::vector<Rgb> levels;  ///< factors, one a group; empty: the light as it is
    /// The mixed light.
    /// @param whole   all groups together
    /// @param groups  one value a group
    [[nodiscard]] Rgb operator()(const Rgb& whole, std::span<const Rgb> groups) const {
        return levels.empty() ? whole : sum(groups);
    }
    /// The same where the whole is not known.
    [[nodiscard]] Rgb sum(std::span<const Rgb> groups) const {
        Rgb mixed;
        for (std::size_t g = 0; g < groups.size(); ++g)
            mixed += levels.empty() ? groups[g] : levels[g] * groups[g];
        return mixed;
    }
    friend bool operator==(const LightMixture&, const LightMixture&) = default;
};

/// What was told of one ray, or of some.
struct GroupAccount {
    std::vector<Rgb> sums;       ///< one a group
    std::vector<Rgb> reflected;  ///< see GroupSums::reflected
    const Ray* root = nullptr;   ///< see ContributionSink, while the account is not the current one
};

/// Adds up the terms of radiance by group. The plain picture's decisions are kept: what is tested,
/// sampled and cached depends on the light of all groups together.
class GroupSums final : public ContributionSink {
  public:
    explicit GroupSums(std::shared_ptr<const LightGroups> groups)
        : groups_(std::move(groups)), first_{std::vector<Rgb>(groups_->size()), {}, nullptr} {}
    GroupSums(const GroupSums&) = delete;
    GroupSums& operator=(const GroupSums&) = delete;

    [[nodiscard]] const LightGroups& groups() const { return *groups_; }
    [[nodiscard]] std::size_t size() const { return first_.sums.size(); }
    void add(const Contribution& term) override {
        account_->sums[groups_->group_of(term.modifier)] += term.value;
    }
    /// The light of all groups times a coefficient; nothing where that is not finite.
    /// @param values  one a group, or none
    void add(const Rgb& coefficient, std::span<const Rgb> values);

    /// What was told since the last clear() [W/(m² sr)], one a group.
    [[nodiscard]] std::span<const Rgb> sums() const { return account_->sums; }
    void clear() {
        std::fill(account_->sums.begin(), account_->sums.end(), Rgb{});
        account_->reflected.clear();
    }

    /// What the last reflected ray that a primary ray has sent out brings to it, one a group;
    /// empty: none since the last clear().
    [[nodiscard]] std::span<const Rgb> reflected() const { return account_->reflected; }
    /// All that was told of this Part is of such a ray.
    void note_reflected() { account_->reflected = account_->sums; }

    /// Where what is told is summed: rays that are shaded together each have their own.
    [[nodiscard]] GroupAccount* account() const { return account_; }
    /// @return  the one before
    GroupAccount* turn_to(GroupAccount* account);
    /// While it lives, what is told goes to an account that somebody else holds.
    class Turned {
      public:
        /// @param sums, account  either null: nothing happens
        Turned(GroupSums* sums, GroupAccount* account) : sums_(account ? sums : nullptr) {
            if (sums_) before_ = sums_->turn_to(account);
        }
        ~Turned() {
            if (sums_) (void)sums_->turn_to(before_);
        }
        Turned(const Turned&) = delete;
        Turned& operator=(const Turned&) = delete;

      private:
        GroupSums* sums_;
        GroupAccount* before_ = nullptr;
    };
    /// While it lives, what is told goes to an account of its own, of the same root.
    class OwnAccount {
      public:
        explicit OwnAccount(GroupSums& sums)
            : account_{std::vector<Rgb>(sums.size()), {}, sums.root()}, turned_(&sums, &account_) {}

      private:
        GroupAccount account_;
        Turned turned_;
    };

    /// While it lives, what is told is summed apart.
    class Part {
      public:
        /// @param sums  null: nothing happens
        /// @param root  which ray's radiance the terms are parts of; it is an ancestor of those
        ///              that are traced meanwhile. The first form: the same as before
        explicit Part(GroupSums* sums) : sums_(sums) {
            if (sums) begin(sums->root());
        }
        Part(GroupSums* sums, const Ray* root) : sums_(sums) {
            if (sums) begin(root);
        }
        ~Part() {
            if (sums_) end();
        }
        Part(const Part&) = delete;
        Part& operator=(const Part&) = delete;
        /// It belongs to what was told before.
        void keep() {
            if (sums_) add_to_before();
        }

      private:
        void begin(const Ray* root);
        void end();
        void add_to_before();
        GroupSums* sums_;
        const Ray* root_before_ = nullptr;
        std::vector<Rgb> before_;
    };

  private:
    std::shared_ptr<const LightGroups> groups_;
    GroupAccount first_;
    GroupAccount* account_ = &first_;
};

}  // namespace lightwalk
