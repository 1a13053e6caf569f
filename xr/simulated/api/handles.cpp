// The table of all objects by their numbers.
#include "xr/simulated/api/handles.h"

#include <algorithm>

namespace simulated {
namespace {

constexpr std::size_t kMostChildren = 4096;

struct Table {
    Object root;
    std::unordered_map<std::uint64_t, Object*> objects;
    // Far from small integers, so that an index taken for a handle is detected.
    std::uint64_t next_number = 0x51A0'0000'0001;
};

Table& table() {
    static Table instance;
    return instance;
}

}  // namespace

Object& root() { return table().root; }

Object* findObject(std::uint64_t number) {
    const auto found = table().objects.find(number);
    return found == table().objects.end() ? nullptr : found->second;
}

void adoptObject(Object& parent, std::unique_ptr<Object> child) {
    require(parent.children.size() < kMostChildren, XR_ERROR_LIMIT_REACHED,
            "one parent has at most 4096 objects");
    child->number = table().next_number++;
    child->parent = &parent;
    table().objects.emplace(child->number, child.get());
    parent.children.push_back(std::move(child));
}

void destroyObject(Object& object) {
    while (!object.children.empty()) { destroyObject(*object.children.back()); }
    table().objects.erase(object.number);
    auto& siblings = object.parent->children;
    siblings.erase(std::find_if(siblings.begin(), siblings.end(),
                                [&](const auto& sibling) { return sibling.get() == &object; }));
}

}  // namespace simulated
