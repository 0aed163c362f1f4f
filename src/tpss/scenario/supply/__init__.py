"""The power supply, one file per noun."""

from tpss.scenario.supply.catenary import Catenary
from tpss.scenario.supply.conductors import Autotransformers, Conductors, LineMatrices
from tpss.scenario.supply.contact_line import ContactLine, NeutralSection, Post, SectionBreak
from tpss.scenario.supply.converter_station import ConverterStation, ConverterType
from tpss.scenario.supply.high_voltage import HighVoltageLine, LineType, Transformer
from tpss.scenario.supply.losses import ConverterLosses
from tpss.scenario.supply.mixed_station import ConverterUnits, MixedStation
from tpss.scenario.supply.rectifier_station import RectifierStation, RectifierType
from tpss.scenario.supply.storage import Storage
from tpss.scenario.supply.supply import Station, Supply
from tpss.scenario.supply.system import System
from tpss.scenario.supply.transformer_station import StationTransformer, TransformerStation

__all__ = [
    "Autotransformers",
    "Catenary",
    "Conductors",
    "ContactLine",
    "ConverterLosses",
    "ConverterStation",
    "ConverterType",
    "ConverterUnits",
    "HighVoltageLine",
    "LineMatrices",
    "LineType",
    "MixedStation",
    "NeutralSection",
    "Post",
    "RectifierStation",
    "RectifierType",
    "SectionBreak",
    "Station",
    "StationTransformer",
    "Storage",
    "Supply",
    "System",
    "Transformer",
    "TransformerStation",
]
