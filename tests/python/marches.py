# SPDX-License-Identifier: BSD-3-Clause
"""Marches with functions of Python: results, errors, threads, Ctrl-C."""
import os
import signal
import threading
import time

import harness
import numpy
import slabhull
from harness import domain, swing

LEVELS = [0.0, 0.1, 0.2]


class Marches(harness.PythonTest):
    def test_a_function_moves_the_body_as_its_integral_says(self):
        for dimension in (2, 3):
            march = slabhull.March(domain(dimension), motions={"body": swing}, reuse="move")
            hull = march.step(LEVELS).hull
            start = march.cap.points.shape[0]
            first, last = hull.points[:start], hull.points[-start:]
            on_body = ((first[:, :-1] >= 2) & (first[:, :-1] <= 3)).all(axis=1)
            tracks = dict(zip(hull.track_ids[-start:], last))
            for v in numpy.flatnonzero(on_body):
                moved = tracks[hull.track_ids[v]][0] - first[v][0]
                self.assertAlmostEqual(moved, 0.5 * 0.2 - 0.2**2 / 2, delta=1e-14)
            self.assertTrue(slabhull.check(hull).clean)

    def test_a_function_gives_the_hull_that_the_librarys_formula_gives(self):
        def turn(x, t):
            return numpy.stack([-0.5 * x[:, 1], 0.5 * x[:, 0]], axis=1)

        centred = slabhull.Domain(*self.centred(2))
        by_function = slabhull.March(centred, motions={"boundary": turn}).step(LEVELS).hull
        by_formula = slabhull.March(centred, motions={"boundary": slabhull.formula(["-0.5*y", "0.5*x"])})
        self.assert_same_hull(by_function, by_formula.step(LEVELS).hull)

    @staticmethod
    def centred(dimension):
        points, cells = harness.grid(5, dimension)
        return points - 2.5, cells

    def test_a_function_is_called_once_a_substep_with_all_vertices(self):
        sizes, threads = [], set()

        def counted(x, t):
            sizes.append(len(x))
            threads.add(threading.get_ident())
            return numpy.zeros_like(x)

        big = domain(3, 13)
        on_boundary = len(numpy.unique(big.mesh.boundary_facets))
        slabhull.March(big, motions={"body": None, "boundary": counted}, reuse="move", substeps=3, scheme="rk4",
                       suggest_layers=False).propose([0, 1, 2])
        self.assertGreater(max(sizes), 600)  # a chunk of the library's own is 512
        self.assertEqual(max(sizes), on_boundary - 8)
        self.assertEqual(threads, {threading.get_ident()})
        stages = 4 * 3 * 2
        self.assertLess(len(sizes), 20 * stages)

    def test_nothing_changes_until_a_slab_is_accepted(self):
        march = slabhull.March(domain(), motions={"body": swing})
        predicted = march.propose(LEVELS)
        march.move("body", lambda x, t: swing(x, t) * 1.1)
        corrected = march.propose(LEVELS)
        self.assertEqual((march.slab, march.time), (0, 0.0))
        self.assert_same(predicted.hull.vertex_ids, corrected.hull.vertex_ids)
        self.assertFalse(numpy.array_equal(predicted.hull.points, corrected.hull.points))
        march.accept(corrected)
        self.assertEqual((march.slab, march.time), (1, 0.2))
        for stale in (predicted, corrected):
            with self.assertRaisesRegex(slabhull.UsageError, "was not proposed"):
                march.accept(stale)
        following = march.step([0.2, 0.3]).hull
        caps = corrected.hull
        self.assert_same(following.points[:following.initial_points],
                         caps.points[caps.initial_points + caps.side_points:])
        self.assert_same(following.vertex_ids[:following.initial_points],
                         caps.vertex_ids[caps.initial_points + caps.side_points:])

    def test_an_exception_of_the_function_comes_out_unchanged(self):
        class Mine(Exception):
            pass

        thrown = Mine("deep inside")

        def fails(x, t):
            raise thrown

        march = slabhull.March(domain(), motions={"body": fails})
        with self.assertRaises(Mine) as raised:
            march.propose(LEVELS)
        self.assertIs(raised.exception, thrown)
        march.move("body", swing)
        march.propose(LEVELS)

    def test_wrong_velocities_are_refused_with_the_patch(self):
        for words, function in [(r'velocity of patch "body" must have the shape \(4, 2\), not \(1, 2\)',
                                 lambda x, t: [[0, 0]]),
                                ('velocity of patch "body" is no array of numbers', lambda x, t: "fast"),
                                (r'velocity of patch "body" is \(nan, 0', lambda x, t: x * 0 + [numpy.nan, 0])]:
            with self.subTest(words), self.assertRaisesRegex(slabhull.Error, words):
                slabhull.March(domain(), motions={"body": function}).propose(LEVELS)

    def test_patches_motions_and_settings_that_there_are_not(self):
        march = slabhull.March(domain())
        for words, call in [('no patch "bdy"; its patches are body, boundary', lambda: march.move("bdy", None)),
                            ("not a int", lambda: march.move("body", 3)),
                            ("2D, not in 3D|3D, not in 2D",
                             lambda: march.move("body", slabhull.translation([1, 0, 0]))),
                            ('no setting "spilt"', lambda: march.configure(spilt="A")),
                            ("substeps: expected a whole number", lambda: march.configure(substeps="many")),
                            ('reuse: expected one of', lambda: march.configure(reuse="never")),
                            ("march's time", lambda: march.propose([0.5, 1]))]:
            with self.subTest(words), self.assertRaisesRegex(slabhull.UsageError, words):
                call()

    def test_a_boundary_that_tangles_says_until_when_it_is_sound(self):
        march = slabhull.March(domain(), motions={"body": slabhull.translation([1, 0])})
        with self.assertRaises(slabhull.TangledBoundary) as raised:
            march.propose(numpy.linspace(0, 4, 9))
        error = raised.exception
        self.assertTrue(1.9 < error.good_until < error.tangled_at < 2.1, (error.good_until, error.tangled_at))
        self.assertEqual({each.kind for each in error.entities}, {"facet"})
        self.assertIsInstance(error, slabhull.GeometryError)

    def test_tracks_and_sequences_move_patches_too(self):
        start = domain()
        places = dict(zip(start.mesh.track_ids, start.mesh.points))

        def by_track(tracks, t):
            return numpy.array([places[k] for k in tracks]) + [0.2 * t, 0]

        by_tracks = slabhull.March(start, motions={"body": slabhull.track_motion(by_track)}).step(LEVELS).hull
        shifted = slabhull.sequence([lambda x, t: x * 0, slabhull.translation([0.2, 0])])
        in_steps = slabhull.March(start, motions={"body": shifted}).step(LEVELS).hull
        self.assertLess(abs(by_tracks.points - in_steps.points).max(), 1e-14)

    def test_progress_is_told_and_may_stop(self):
        told = []
        march = slabhull.March(domain(3), motions={"body": swing},
                               on_progress=lambda progress: told.append(progress.stage))
        march.propose(LEVELS)
        self.assertIn("cap meshing", told)
        march.on_progress = lambda progress: False
        with self.assertRaises(slabhull.Interrupted):
            march.propose(LEVELS)
        march.on_progress = lambda progress: 1 / 0
        with self.assertRaises(ZeroDivisionError):
            march.propose(LEVELS)
        march.on_progress = None
        march.propose(LEVELS)

    def test_a_march_is_not_changed_while_it_proposes(self):
        march = slabhull.March(domain())

        def meddles(x, t):
            march.move("body", None)

        march.move("body", meddles)
        with self.assertRaisesRegex(slabhull.UsageError, "is proposing"):
            march.propose(LEVELS)


class Interpreter(harness.PythonTest):
    @classmethod
    def setUpClass(cls):
        cls.long = slabhull.Case.experiment("ellipsoid", 3).march()  # some seconds

    def test_ctrl_c_stops_within_a_second(self):
        sent = []

        def send():
            time.sleep(0.3)
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        sender = threading.Thread(target=send)
        sender.start()
        with self.assertRaises(KeyboardInterrupt):
            self.long.propose(numpy.linspace(0, 1, 200))
        self.assertLess(time.monotonic() - sent[0], 1.0)
        sender.join()
        self.assertEqual(self.long.slab, 0)

    def test_other_threads_run_while_cplusplus_works(self):
        beats, stop = [], threading.Event()

        def beat():
            while not stop.is_set():
                beats.append(time.monotonic())
                time.sleep(0.005)

        thread = threading.Thread(target=beat)
        thread.start()
        began = time.monotonic()
        slabhull.Case.experiment("ellipsoid", 1).march().propose([0, 0.05, 0.1])
        took = time.monotonic() - began
        stop.set()
        thread.join()
        self.assertGreater(len(beats), 0.25 * took / 0.005)

    def test_marches_in_two_threads_call_back_at_once(self):
        hulls = {}

        def run(name):
            hulls[name] = slabhull.March(domain(3), motions={"body": swing}).step(LEVELS).hull

        threads = [threading.Thread(target=run, args=(k,)) for k in range(3)]
        for each in threads:
            each.start()
        for each in threads:
            each.join()
        self.assert_same_hull(hulls[0], hulls[1])
        self.assert_same_hull(hulls[0], hulls[2])


if __name__ == "__main__":
    harness.main()
