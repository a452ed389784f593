"""Words that no template alone can say: of a case, of a diagnostic, of numbers."""
