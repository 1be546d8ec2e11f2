"""What a run is judged by: metrics of its signals and limits on them."""

from hilbed.criteria.judge import Judged, judge
from hilbed.criteria.metrics import DRIVE_METRICS, METRICS, RUN_METRICS, Metric, all_metrics, measure
from hilbed.criteria.signals import Missing, Signals, window
from hilbed.criteria.spec import CriterionSpec, metric_of
from hilbed.criteria.windows import window_text

__all__ = [
    "DRIVE_METRICS",
    "METRICS",
    "RUN_METRICS",
    "CriterionSpec",
    "Judged",
    "Metric",
    "Missing",
    "Signals",
    "all_metrics",
    "judge",
    "measure",
    "metric_of",
    "window",
    "window_text",
]
