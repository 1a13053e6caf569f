// Text that is typed on the panel: with its keys, at which a ray or a mouse points, or with a keyboard.
#pragma once

#include <string>
#include <utility>

namespace binosplat {

class TextEntry {
public:
    enum class What { kNothing, kViewpointName, kMetres };

    // From now on the panel asks for it, in place of its page.
    void open(What what, std::string title, std::string text);
    void close() { what_ = What::kNothing; }
    [[nodiscard]] bool isOpen() const { return what_ != What::kNothing; }
    [[nodiscard]] What what() const { return what_; }
    [[nodiscard]] const std::string& title() const { return title_; }
    [[nodiscard]] const std::string& text() const { return text_; }

    // Adds a letter in UTF-8, if there is space; removes the last one; does what Return does.
    void type(const std::string& letter);
    void eraseLast();
    void confirm() { is_confirmed_ = true; }
    [[nodiscard]] bool takeConfirmed() { return std::exchange(is_confirmed_, false); }

    bool capitals = false;  // of the panel's keys

private:
    What what_ = What::kNothing;
    std::string title_, text_;
    bool is_confirmed_ = false;
};

}  // namespace binosplat
