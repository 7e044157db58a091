// SPDX-License-Identifier: BSD-3-Clause
#include "python/errors.h"

#include "slabhull/core/progress.h"
#include "slabhull/slab/layers.h"
#include "slabhull/slab/tangling.h"

#include <exception>

namespace slabhull::python {

namespace py = pybind11;

namespace {

py::object of_errors(const char* name) {
    return py::module_::import("slabhull.errors").attr(name);
}

template<class... More>
void raise(const char* name, const Error& error, const More&... more) {
    const py::object type = of_errors(name);
    const py::object value = type(error.what(), as_list(error.entities), more...);
    PyErr_SetObject(type.ptr(), value.ptr());
}

/// The nearest class that slabhull/errors.py has; subclasses come first.
void translate(std::exception_ptr thrown) {
    try {
        std::rethrow_exception(std::move(thrown));
    } catch (const TangledBoundary& error) {
        raise("TangledBoundary", error, error.good_until, error.tangled_at);
    } catch (const TooManyLayers& error) {
        raise("TooManyLayers", error);
    } catch (const LimitError& error) {
        raise("LimitError", error);
    } catch (const GeometryError& error) {
        raise("GeometryError", error);
    } catch (const UsageError& error) {
        raise("UsageError", error);
    } catch (const InputError& error) {
        raise("InputError", error);
    } catch (const FormatLimit& error) {
        raise("FormatLimit", error);
    } catch (const OutputError& error) {
        raise("OutputError", error);
    } catch (const Interrupted& error) {
        raise("Interrupted", error);
    } catch (const Error& error) {
        raise("Error", error);
    }
}

} // namespace

void translate_errors() {
    py::register_exception_translator(translate);
}

py::list as_list(const std::vector<Entity>& entities) {
    const py::object tuple = of_errors("Entity");
    py::list list;
    for (const Entity& entity : entities) {
        list.append(tuple(entity.kind, entity.number, entity.patch));
    }
    return list;
}

} // namespace slabhull::python
