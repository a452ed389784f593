"""Words that pages share: of a case, of a diagnostic, of numbers."""
