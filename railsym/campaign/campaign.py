# SPDX-License-Identifier: BSD-3-Clause
"""A campaign: the study, its uncertainty, its optimisations, one after another; what is on disk is not computed again."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter

from railsym.campaign.errors import CampaignError
from railsym.campaign.optimisation import Optimisation
from railsym.campaign.results import CampaignResults, Optimised, Stage
from railsym.campaign.uncertainty import Uncertainty, assess, probability_of, sobol_study
from railsym.campaign.variants import variant


@dataclass(frozen=True, eq=False)
class Campaign:
    """A study file.

    Attributes
    ----------
    study : railsym.sweep.Study
    uncertainty : Uncertainty or None
    optimisations : tuple of Optimisation
    title, description : str
    path : Path or None
        Of the file.
    text : str
        Of the file.
    """

    study: object
    uncertainty: Uncertainty | None = None
    optimisations: tuple[Optimisation, ...] = ()
    title: str = ""
    description: str = ""
    path: Path | None = None
    text: str = field(default="", repr=False)

    def files(self, store):
        """Files that a run writes, by what they hold."""
        store = Path(store)
        found = {"study": store}
        if self.uncertainty is not None and self.uncertainty.sobol:
            found["sobol"] = store.with_name(f"{store.stem}_sobol.nc")
        for one in self.optimisations:
            found[f"optimise.{one.name}"] = store.with_name(f"{store.stem}_{one.name}.jsonl")
            if one.recheck:
                found[f"recheck.{one.name}"] = store.with_name(f"{store.stem}_{one.name}.nc")
        return found

    def _check_packages(self):
        """What is missing is said before hours of computing."""
        from railsym.uncertainty.packages import needed

        if self.uncertainty is not None and self.uncertainty.sobol:
            needed("SALib.analyze.sobol", "Sobol indices")
        if any(one.pareto for one in self.optimisations):
            needed("pymoo.algorithms.moo.nsga2", "Pareto fronts")

    def run(self, store, *, workers: int = 1, executor=None, resume: bool = False, progress: bool = False,
            say: Callable[[str], None] | None = None) -> CampaignResults:
        """Compute what the files do not hold yet.

        Parameters
        ----------
        store : path
            Of the study's results (netCDF); the other files lie beside it with its name in theirs.
        workers, executor
            As `railsym.sweep.run`.
        resume : bool
            Go on with files that exist; without it they are an error.
        progress : bool
            Bars on the error stream.
        say : callable, optional
            Called with a line a stage.

        Returns
        -------
        CampaignResults

        Raises
        ------
        CampaignError
            Files that exist, without `resume`.
        RailsymError
            What the study or an optimisation raises; what was computed is on disk.
        """
        files = self.files(store)
        self._check_packages()
        if not resume:
            _refuse(files)
        say = say or (lambda text: None)
        run = _Run(self, files, workers, executor, progress, say)
        with ExitStack() as stack:
            if self.optimisations:
                from railsym.sweep.executors import door

                run.pool = door(workers, executor)
                stack.callback(run.pool.close if run.pool is not None else lambda: None)
            return run.all()


def _refuse(files):
    from railsym.sweep.journal import journal_of

    there = [p for path in files.values() for p in (path, journal_of(path)) if p.exists()]
    if there:
        raise CampaignError(f"{there[0]} exists: go on with it (--resume, resume=True), or name another store")


@dataclass
class _Run:
    campaign: Campaign
    files: dict
    workers: int
    executor: object
    progress: bool
    say: Callable
    pool: object = None
    stages: list = field(default_factory=list)

    def all(self):
        campaign = self.campaign
        results = self.study("study", campaign.study)
        uncertainty = None
        if campaign.uncertainty is not None:
            sobol = self.study("sobol", sobol_study(campaign.study, campaign.uncertainty)) if campaign.uncertainty.sobol else None
            uncertainty = self.stage("uncertainty", "tornado, probability, first-order reliability, Sobol indices",
                                     lambda: assess(campaign.uncertainty, results, sobol))
        optimised = tuple(self.optimise(one) for one in campaign.optimisations)
        return CampaignResults(campaign, results, uncertainty, optimised, tuple(self.stages), self.files, self.workers)

    def stage(self, name, text, work):
        self.say(f"{name}: {text}")
        start = perf_counter()
        found = work()
        message = getattr(found, "message", "")
        self.stages.append(Stage(name, text, perf_counter() - start, message))
        if message:
            self.say(f"  {message}")
        for case, error in list(getattr(found, "errors", {}).items())[:1]:
            self.say(f"  the first that failed, case {case}: {error}")
        return found

    def study(self, name, study):
        text = f"{study.size} cases by {study.plan.kind.replace('_', ' ')} over {len(study.names)} factors"
        return self.stage(name, text, lambda: study.run(self.files[name], workers=self.workers, executor=self.executor, progress=self.progress))

    def optimise(self, one):
        name = f"optimise.{one.name}"
        text = f"{' and '.join(f'{o.sense} {o.name}' for o in one.problem.objectives)} over {', '.join(one.problem.names)}"
        found = self.stage(name, text, lambda: self._optimise(one, self.files[name]))
        if not one.recheck:
            return Optimised(one, found)
        again = self.study(f"recheck.{one.name}", variant(self.campaign.study, set=found.values))
        return Optimised(one, found, again, self._probability(again))

    def _optimise(self, one, history):
        if not self.progress:
            return one.run(history, True, self.pool, None)
        from tqdm import tqdm

        with tqdm(desc="optimisation", unit="case") as bar:
            return one.run(history, True, self.pool, lambda case: bar.update())

    def _probability(self, results):
        from railsym.uncertainty import UncertaintyError

        settings = self.campaign.uncertainty
        if settings is None or settings.limit is None:
            return None
        try:
            return probability_of(settings, results)
        except UncertaintyError as error:
            self.say(f"  {error}")
            return None
