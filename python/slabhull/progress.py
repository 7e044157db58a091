# SPDX-License-Identifier: BSD-3-Clause
"""A bar that shows the progress of long work: tqdm's where that is installed, else a line on a terminal."""
import sys

try:
    from tqdm.auto import tqdm
except ImportError:
    tqdm = None


class ProgressBar:
    """To be given as `on_progress`: case.run(on_progress=slabhull.ProgressBar()).

    A run shows the part of its time that has passed, other work that of its stage. `with ProgressBar() as bar:` closes
    the bar however the work ends. `file`: where to, stderr by default.
    """

    def __init__(self, file=None):
        self._file = file or sys.stderr
        self._bar = None
        self._line = False

    def __call__(self, progress):
        share = progress.share if progress.slabs else progress.stage_share
        text = progress.stage if progress.slab is None else f"slab {progress.slab}: {progress.stage}"
        if tqdm is not None:
            self._show_bar(text, share)
        elif self._file.isatty():
            self._line = True
            print(f"\r\033[K{text}" + (f" {share:.0%}" if share is not None else ""), end="", file=self._file, flush=True)
        if progress.slabs and progress.share >= 1:
            self.close()

    def _show_bar(self, text, share):
        if self._bar is None:
            self._bar = tqdm(total=100, unit="%", file=self._file, bar_format="{l_bar}{bar}| {elapsed}<{remaining}")
        self._bar.set_description(text, refresh=False)
        self._bar.n = round(100 * (share or 0), 1)
        self._bar.refresh()

    def close(self):
        """Ends the bar; the next call begins another."""
        if self._bar is not None:
            self._bar.close()
            self._bar = None
        if self._line:
            print(file=self._file)
            self._line = False

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
