#include "io/bsdf/tree_text.h"

#include <array>
#include <span>
#include <vector>

namespace lightwalk {
namespace {

using Token = XmlNumbers::Token;

/// Reads nodes; `numbers` stands at the opening brace of the next one.
class TreeReader {
  public:
    TreeReader(int rank, XmlNumbers& numbers) : tree_(rank), numbers_(numbers) {}

    TensorTree read() {
        if (numbers_.next() != Token::open) throw numbers_.error("expected { of a tensor tree");
        tree_.set_root(node(0));
        if (numbers_.next() != Token::end)
            throw numbers_.error("something follows the end of the tensor tree");
        return TensorTree(tree_.rank(), std::vector(tree_.nodes()), tree_.root());
    }

  private:
    TensorTree::Entry node(int level) {
        const Token first = numbers_.next();
        if (first == Token::open) return divided(level + 1);
        if (first == Token::number) return grid(level);
        throw numbers_.error("a node of the tensor tree is empty");
    }

    TensorTree::Entry divided(int level) {
        if (level > TensorTree::kMostLevels) throw too_deep();
        std::array<TensorTree::Entry, TensorTree::kMostChildren> children{};
        for (std::size_t c = 0; c < tree_.children(); ++c) {
            // The brace of the first child has been read.
            if (c > 0 && numbers_.next() != Token::open) throw wrong_children();
            children[c] = node(level);
        }
        if (numbers_.next() != Token::close) throw wrong_children();
        return tree_.add(std::span(children).first(tree_.children()));
    }

    TensorTree::Entry grid(int level) {
        values_.clear();
        for (; numbers_.last() == Token::number; numbers_.next())
            values_.push_back(static_cast<float>(numbers_.value()));
        if (numbers_.last() != Token::close)
            throw numbers_.error("expected } after the values of a node of the tensor tree");
        int levels = 0;
        std::size_t count = 1;
        for (; count < values_.size(); ++levels) count <<= tree_.rank();
        if (count != values_.size()) {
            throw numbers_.error("a node of the tensor tree has " + std::to_string(values_.size()) +
                                 " values, expected a power of " +
                                 std::to_string(tree_.children()));
        }
        if (level + levels > TensorTree::kMostLevels) throw too_deep();
        return tree_.add_grid(values_, levels);
    }

    [[nodiscard]] InputError too_deep() const {
        return numbers_.error("the tensor tree is deeper than " +
                              std::to_string(TensorTree::kMostLevels) + " levels");
    }
    [[nodiscard]] InputError wrong_children() const {
        return numbers_.error("a node of the tensor tree has not " +
                              std::to_string(tree_.children()) + " nodes, as its rank wants");
    }

    TensorTree tree_;
    XmlNumbers& numbers_;
    std::vector<float> values_;
};

}  // namespace

TensorTree read_tree(int rank, XmlNumbers& numbers) {
    return TreeReader(rank, numbers).read();
}

}  // namespace lightwalk
