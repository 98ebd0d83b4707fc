# Names that other packages use, each with the module that has it.
from .labelling import LabelledFile as LabelledFile
from .labelling import write_labelled as write_labelled
from .signatures import is_virtual_cloud as is_virtual_cloud
from .signatures import list_named_files as list_named_files
from .signatures import list_tiles as list_tiles
from .virtual_cloud import NamedFile as NamedFile
from .virtual_cloud import write_virtual_cloud as write_virtual_cloud
