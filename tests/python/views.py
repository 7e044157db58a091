# SPDX-License-Identifier: BSD-3-Clause
"""Arrays of hulls, caps and fillings: views without a copy, read-only, alive as long as they are looked at."""
import gc
import weakref

import harness
import numpy
import slabhull
from harness import address, domain, swing

LEVELS = [0.0, 0.1, 0.2]
VIEWS = ("points", "cells", "neighbors", "facet_patch")
MADE_ONCE = ("region", "patch", "layer", "vertex_ids", "track_ids")


def memory_of_this_process():
    with open("/proc/self/statm") as file:
        return 4096 * int(file.read().split()[1])


class Views(harness.PythonTest):
    def setUp(self):
        super().setUp()
        self.march = slabhull.March(domain(), motions={"body": swing}, reuse="move")
        self.slab = self.march.propose(LEVELS)

    def test_views_have_one_address_however_often_they_are_asked_for(self):
        for name in VIEWS:
            with self.subTest(name):
                first, again = getattr(self.slab.hull, name), getattr(self.slab.hull, name)
                self.assertIsNot(first, again)
                self.assertEqual(address(first), address(again))
                self.assertFalse(first.flags.owndata)
                self.assertTrue(first.flags.c_contiguous)

    def test_columns_that_are_not_stored_are_made_once(self):
        for name in MADE_ONCE:
            with self.subTest(name):
                self.assertIs(getattr(self.slab.hull, name), getattr(self.slab.hull, name))

    def test_accepting_a_slab_copies_and_moves_nothing_of_its_hull(self):
        hull = self.slab.hull
        before = {name: (address(getattr(hull, name)), getattr(hull, name).copy()) for name in VIEWS}
        self.march.accept(self.slab)
        self.march.step([0.2, 0.3])
        for name, (place, values) in before.items():
            self.assertEqual(address(getattr(hull, name)), place)
            self.assert_same(getattr(hull, name), values)

    def test_types_and_shapes(self):
        hull = self.slab.hull
        self.assertEqual(hull.points.shape[1], 3)
        self.assertEqual(hull.cells.shape[1], 3)
        self.assertEqual((hull.points.dtype, hull.cells.dtype, hull.neighbors.dtype), ("f8", "u4", "i4"))
        self.assertEqual((hull.region.dtype, hull.vertex_ids.dtype), ("i4", "i8"))
        self.assertEqual(len(hull.region), len(hull.cells))
        self.assertEqual(len(hull.track_ids), len(hull.points))
        self.assertEqual(hull.initial_cells, (hull.region == 0).sum())
        self.assertEqual(hull.side_cells, (hull.region == 1).sum())
        self.assertEqual(set(hull.layer[hull.region == 1]), {0, 1})

    def test_nothing_can_be_written(self):
        for name in VIEWS + MADE_ONCE:
            with self.subTest(name), self.assertRaises(ValueError):
                getattr(self.slab.hull, name).flat[0] = 1
        with self.assertRaises(ValueError):
            self.slab.hull.points.flags.writeable = True

    def test_views_outlive_slab_hull_and_march(self):
        kept = {name: getattr(self.slab.hull, name) for name in VIEWS + MADE_ONCE}
        cap = self.march.cap.points
        copies = {name: values.copy() for name, values in kept.items()}
        cap_copy = cap.copy()
        self.march.accept(self.slab)
        del self.slab, self.march
        gc.collect()
        trash = [numpy.full(100_000, 7.0) for _ in range(20)]
        for name in kept:
            self.assert_same(kept[name], copies[name])
        self.assert_same(cap, cap_copy)
        del trash

    def test_what_nobody_looks_at_is_freed(self):
        march = slabhull.March(domain(3, 21), motions={"body": None}, reuse="move")
        march.step([0.0, 1.0])
        before = memory_of_this_process()
        for k in range(1, 20):
            slab = march.step([k, k + 1.0])
        size = sum(getattr(slab.hull, name).nbytes for name in VIEWS)
        self.assertLess(memory_of_this_process() - before, 6 * size)

    def test_the_function_of_a_march_goes_with_it(self):
        def velocity(x, t):
            return x * 0

        gone = weakref.ref(velocity)
        self.march.move("body", velocity)
        self.march.propose(LEVELS)
        del velocity
        self.assertIsNotNone(gone())
        self.march.move("body", None)
        gc.collect()
        self.assertIsNone(gone())

    def test_a_function_may_keep_the_places_that_it_is_given(self):
        kept = []

        def velocity(x, t):
            kept.append((x, x.copy()))
            return x * 0

        self.march.move("body", velocity)
        self.march.propose(LEVELS)
        for given, copy in kept:
            self.assert_same(given, copy)

    def test_caps_fillings_and_sections_are_views_too(self):
        filling = slabhull.fill(self.slab)
        for mesh, names in [(self.march.cap, ("points", "cells", "neighbors", "vertex_ids", "track_ids")),
                            (filling, ("points", "cells", "neighbors", "facets", "facet_attribute")),
                            (slabhull.slice(self.slab, 0.15), ("points", "facets", "patch", "neighbors")),
                            (slabhull.slice(filling, 0.15), ("points", "cells", "neighbors", "boundary_facets"))]:
            for name in names:
                with self.subTest(f"{type(mesh).__name__}.{name}"):
                    self.assertEqual(address(getattr(mesh, name)), address(getattr(mesh, name)))
                    self.assertFalse(getattr(mesh, name).flags.writeable)


if __name__ == "__main__":
    harness.main()
