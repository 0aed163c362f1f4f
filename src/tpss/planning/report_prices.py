"""Tables of what a plan assumes: prices with their year and source, measures, renewals, scenarios."""

from collections.abc import Iterator
from typing import Any

import pandas as pd

from tpss.planning.plan import PlanFile
from tpss.planning.plan_faults import prices_of
from tpss.planning.report_tables import cut
from tpss.planning.wording import number, varied_in_words
from tpss.planning.written import Written
from tpss.report.tables import Table

NO_SOURCE = "none given"
"""Stands where a price has no source."""


def tables_of_prices(written: Written) -> list[Table]:
    """All tables of what a plan assumes."""
    tables = {
        "prices": (f"Prices and values [{written.file.economics.currency}]", _prices(written.file)),
        "measures": ("Measures that may be built", _measures(written.file)),
        "renewals": ("Renewals of today’s equipment", _renewals(written.file)),
        "scenarios": ("Scenarios", _scenarios(written)),
    }
    frames = {key: (caption, pd.DataFrame(list(rows))) for key, (caption, rows) in tables.items()}
    return [cut(key, caption, each) for key, (caption, each) in frames.items() if len(each)]


def without_source(file: PlanFile) -> list[str]:
    """Prices without a source, in words."""
    silent = [
        varied_in_words(f"economics.{k}") for k, each in prices_of(file).items() if not each.source
    ]
    silent += [f"cost of {name}" for name, each in file.measures.items() if not each.source]
    return silent + [f"renewal {name}" for name, each in file.renewals.items() if not each.source]


def _prices(file: PlanFile) -> Iterator[dict[str, Any]]:
    for key, price in prices_of(file).items():
        yield {
            "price": varied_in_words(f"economics.{key}"),
            "value": number(price.value),
            "price year": price.price_year or file.economics.price_year,
            "source": price.source or NO_SOURCE,
        }


def _measures(file: PlanFile) -> Iterator[dict[str, Any]]:
    currency = file.economics.currency
    for name, each in file.measures.items():
        levels = each.levels or ("",)
        costs = [
            f"{level}: {number(cost)}" if each.levels else number(cost)
            for level, cost in zip(levels, each.costs, strict=True)
        ]
        yield {
            "measure": name,
            "title": each.title,
            f"cost [{currency}]": "; ".join(costs),
            f"fixed a year [{currency}]": number(each.fixed_per_year),
            "life [years]": f"{each.lifetime_years:g}",
            "order to service [years]": f"{each.lead_time_years:g}",
            "price year": each.price_year or file.economics.price_year,
            "source": each.source or NO_SOURCE,
        }


def _renewals(file: PlanFile) -> Iterator[dict[str, Any]]:
    for name, each in file.renewals.items():
        yield {
            "renewal": name,
            "title": each.title,
            "due in": each.year,
            f"cost [{file.economics.currency}]": number(each.amount),
            "life [years]": f"{each.lifetime_years:g}",
            "not needed with": ", ".join(each.unless),
            "price year": each.price_year or file.economics.price_year,
            "source": each.source or NO_SOURCE,
        }


def _scenarios(written: Written) -> Iterator[dict[str, Any]]:
    start = written.file.stages.start
    for name, future in written.futures.items():
        for path, value in future.values.items() or {"as today": ""}.items():
            values = value if isinstance(value, list | tuple) else [value] * len(start)
            by_stage = {str(year): _plain(each) for year, each in zip(start, values, strict=True)}
            yield {
                "scenario": name,
                "title": future.title,
                "probability [%]": f"{100.0 * future.probability:.4g}",
                "value": path,
                **by_stage,
            }


def _plain(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)
