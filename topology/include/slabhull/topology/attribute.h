// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slabhull/core/error.h"
#include "slabhull/core/index.h"

#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace slabhull {

/// Values of type T on all elements of one kind; asked with an id of that kind and no other.
template<class T, class IdType>
class Attribute {
    static_assert(!std::is_same_v<T, bool>, "std::vector<bool> has no values to refer to: take char");

public:
    Attribute(std::size_t count, const T& initial) : values_(count, initial) {}

    T& operator[](IdType id) { return values_[id.slot()]; }
    const T& operator[](IdType id) const { return values_[id.slot()]; }
    std::size_t size() const { return values_.size(); }

    /// All values in the order of the ids, for bulk work.
    std::span<T> values() { return values_; }
    std::span<const T> values() const { return values_; }

private:
    std::vector<T> values_;
};

/// Any number of attributes of the elements of one kind, by name. All have as many values as there are
/// elements: the count is that of the mesh which owns the set. References to attributes stay valid until they
/// are removed or the mesh dies, also when it is moved.
template<class IdType>
class AttributeSet {
public:
    explicit AttributeSet(std::size_t count) : count_{count} {}
    AttributeSet(const AttributeSet&) = delete; // so that a mesh keeps the one that fits it
    AttributeSet& operator=(const AttributeSet&) = delete;

    std::size_t element_count() const { return count_; }

    /// A new attribute. Throws UsageError when there is one of that name, of whatever type.
    template<class T>
    Attribute<T, IdType>& add(const std::string& name, const T& initial = T{}) {
        if (columns_.contains(name)) {
            throw UsageError{"there is an attribute \"" + name + "\" already"};
        }
        auto column = std::make_unique<ColumnOf<T>>(count_, initial);
        Attribute<T, IdType>& added = column->attribute;
        columns_.emplace(name, std::move(column));
        return added;
    }

    /// The attribute of that name and type, or null.
    template<class T>
    Attribute<T, IdType>* find(std::string_view name) {
        const auto entry = columns_.find(name);
        auto* column = entry == columns_.end() ? nullptr : dynamic_cast<ColumnOf<T>*>(entry->second.get());
        return column == nullptr ? nullptr : &column->attribute;
    }
    template<class T>
    const Attribute<T, IdType>* find(std::string_view name) const {
        return const_cast<AttributeSet&>(*this).find<T>(name);
    }

    /// Whether there was one.
    bool remove(std::string_view name) {
        const auto entry = columns_.find(name);
        if (entry == columns_.end()) {
            return false;
        }
        columns_.erase(entry);
        return true;
    }

    /// Ascending.
    std::vector<std::string> names() const {
        std::vector<std::string> result;
        for (const auto& [name, column] : columns_) {
            result.push_back(name);
        }
        return result;
    }

    /// Adds the attributes of a mesh that ours is a part of: our element k is its element chosen[k]. One that
    /// we have already stays.
    void take_share(const AttributeSet& whole, std::span<const IdType> chosen) {
        for (const auto& [name, column] : whole.columns_) {
            if (!columns_.contains(name)) {
                columns_.emplace(name, column->share(chosen.first(count_)));
            }
        }
    }

private:
    struct Column {
        virtual ~Column() = default;
        virtual std::unique_ptr<Column> share(std::span<const IdType> chosen) const = 0;
    };

    template<class T>
    struct ColumnOf final : Column {
        ColumnOf(std::size_t count, const T& initial) : attribute{count, initial} {}

        std::unique_ptr<Column> share(std::span<const IdType> chosen) const override {
            auto result = std::make_unique<ColumnOf>(chosen.size(), T{});
            for (std::size_t k = 0; k < chosen.size(); ++k) {
                result->attribute.values()[k] = attribute[chosen[k]];
            }
            return result;
        }

        Attribute<T, IdType> attribute;
    };

    std::size_t count_;
    std::map<std::string, std::unique_ptr<Column>, std::less<>> columns_;
};

} // namespace slabhull
